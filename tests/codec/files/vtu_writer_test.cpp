// The writer is judged by VTK: what it reads back must be what was written, to the bit.
#include "codec/files/vtu_writer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "codec/files/atomic_file.h"
#include "simplify/read/read_mesh.h"
#include "tests/support/meshes.h"

namespace qtet {
namespace {

ReadMesh readBack(const Bytes& bytes, const std::string& name) {
  const auto path = testing::freshFolder("vtu-writer-" + name) / "mesh.vtu";
  const Status written = writeFileAtomically(path, bytes);
  EXPECT_TRUE(written);
  Result<ReadMesh> read = readMesh(path);
  EXPECT_TRUE(read) << read.error().text();
  return read ? std::move(*read) : ReadMesh{};
}

std::string textOf(const Bytes& bytes) { return {bytes.begin(), bytes.end()}; }

void expectTheLatticeSurvives(const LatticeMesh& mesh, const std::string& name) {
  const ReadMesh read = readBack(vtuBytes(mesh), name);
  EXPECT_TRUE(read.report.notes.empty());
  ASSERT_EQ(read.mesh.tetrahedra, mesh.tetrahedra);
  ASSERT_EQ(read.mesh.points.size(), mesh.points.size());
  for (std::size_t v = 0; v < mesh.points.size(); ++v) {
    for (std::size_t k = 0; k < 3; ++k)
      ASSERT_EQ(std::lround((read.mesh.points[v][k] - mesh.lattice.origin[k]) / mesh.lattice.step),
                mesh.points[v][k])
          << "vertex " << v;
  }
}

TEST(VtuWriter, vtkReadsTheLatticeBack) {
  const LatticeMesh mesh = testing::gridMesh(4, 5);
  expectTheLatticeSurvives(mesh, "grid");
  const ReadMesh read = readBack(vtuBytes(mesh), "grid-fields");
  ASSERT_EQ(read.mesh.fields.size(), mesh.fields.size());
  for (std::size_t f = 0; f < mesh.fields.size(); ++f) {
    const FieldInfo& info = mesh.fields[f];
    EXPECT_EQ(read.mesh.fields[f].name, info.name);
    EXPECT_EQ(read.mesh.fields[f].type, info.type);
    ASSERT_EQ(read.mesh.fields[f].components, info.components);
    for (std::size_t i = 0; i < mesh.values[f].size(); ++i) {
      ASSERT_EQ(std::lround((read.mesh.fields[f].values[i] - info.minimum[i % info.components]) /
                            info.step),
                mesh.values[f][i]);
    }
  }
}

TEST(VtuWriter, cellFieldsAreCellData) {
  LatticeMesh mesh = testing::gridMesh(3, 5);
  testing::addCellFields(mesh);
  const ReadMesh read = readBack(vtuBytes(mesh), "cells");
  ASSERT_EQ(read.mesh.fields.size(), 4u);
  for (std::size_t f = 2; f < 4; ++f) {
    const FieldInfo& info = mesh.fields[f];
    EXPECT_EQ(read.mesh.fields[f].name, info.name);
    EXPECT_EQ(read.mesh.fields[f].association, "cell");
    EXPECT_EQ(read.mesh.fields[f].type, info.type);
    ASSERT_EQ(read.mesh.fields[f].values.size(), mesh.values[f].size());
    for (std::size_t i = 0; i < mesh.values[f].size(); ++i)
      ASSERT_EQ(read.mesh.fields[f].values[i],
                info.minimum[i % info.components] + info.step * mesh.values[f][i]);
  }
}

TEST(VtuWriter, pointsBecomeDoublesWhereFloatsWouldMergeLatticePoints) {
  LatticeMesh mesh = testing::gridMesh(2, 1);
  mesh.lattice = {16, 1e-3, {100, 200, 300}};
  expectTheLatticeSurvives(mesh, "near");
  EXPECT_NE(textOf(vtuBytes(mesh)).find("\"Float32\" Name=\"Points\""), std::string::npos);
  mesh.lattice.origin = {1e6, 0, 0};
  expectTheLatticeSurvives(mesh, "far");
  EXPECT_NE(textOf(vtuBytes(mesh)).find("\"Float64\" Name=\"Points\""), std::string::npos);
}

TEST(VtuWriter, everyNumberTypeKeepsItsExtremes) {
  const std::vector<std::array<double, 3>> points{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const std::vector<Tetrahedron> cells{{0, 1, 2, 3}};
  FileMesh mesh{points, cells, true, {}};
  const double big = 9007199254740991.0;  // 2^53 - 1
  mesh.pointFields = {{"i8", "int8", 1, {-128, 127, 0, 1}},
                      {"u8", "uint8", 1, {0, 255, 1, 2}},
                      {"i16", "int16", 1, {-32768, 32767, 0, 1}},
                      {"u16", "uint16", 1, {0, 65535, 1, 2}},
                      {"i32", "int32", 1, {-2147483648.0, 2147483647.0, 0, 1}},
                      {"u32", "uint32", 1, {0, 4294967295.0, 1, 2}},
                      {"i64", "int64", 1, {-big, big, 0, 1}},
                      {"u64", "uint64", 1, {0, big, 1, 2}},
                      {"f32", "float32", 1, {-1.5, 0.25, 3, 4}},
                      {"f64", "float64", 2, {0.1, 0.2, 0.3, 1e300, -1e-300, 6, 7, 8}}};
  const ReadMesh read = readBack(vtuBytes(mesh), "types");
  ASSERT_EQ(read.mesh.fields.size(), mesh.pointFields.size());
  for (std::size_t f = 0; f < mesh.pointFields.size(); ++f) {
    EXPECT_EQ(read.mesh.fields[f].type, mesh.pointFields[f].type);
    EXPECT_EQ(read.mesh.fields[f].values, *mesh.pointFields[f].values.get())
        << mesh.pointFields[f].name;
  }
}

TEST(VtuWriter, valuesOutsideAnIntegerTypeAreRoundedAndClamped) {
  const std::vector<std::array<double, 3>> points{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const std::vector<Tetrahedron> cells{{0, 1, 2, 3}};
  const FileMesh mesh{points, cells, true, {{"u8", "uint8", 1, {-3, 256, 1.6, std::nan("")}}}};
  EXPECT_EQ(readBack(vtuBytes(mesh), "clamp").mesh.fields.at(0).values,
            (std::vector<double>{0, 255, 2, 0}));
}

TEST(VtuWriter, namesAreEscaped) {
  const std::vector<std::array<double, 3>> points{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const std::vector<Tetrahedron> cells{{0, 1, 2, 3}};
  const std::string name = "p <\"a\"> & 'b'\ttab \xc3\xa9";
  const FileMesh mesh{points, cells, true, {{name, "float32", 1, {1, 2, 3, 4}}}};
  EXPECT_EQ(readBack(vtuBytes(mesh), "names").mesh.fields.at(0).name, name);
}

TEST(VtuWriter, isDeterministic) {
  EXPECT_EQ(vtuBytes(testing::gridMesh(3, 9)), vtuBytes(testing::gridMesh(3, 9)));
}

}  // namespace
}  // namespace qtet
