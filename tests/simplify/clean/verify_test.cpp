#include "simplify/clean/verify.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>

#include "simplify/clean/quantise.h"
#include "tests/simplify/mesh/tet_meshes.h"

namespace qtet {
namespace {

LatticeMesh small() {
  LatticeMesh mesh = testing::gridMesh(4, 2);
  testing::addCellFields(mesh);
  return mesh;
}

/// The same mesh in another numbering, cells rotated evenly.
LatticeMesh renumbered(const LatticeMesh& mesh, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::vector<VertexId> place(mesh.points.size());
  std::iota(place.begin(), place.end(), 0u);
  std::shuffle(place.begin(), place.end(), random);
  LatticeMesh out = mesh;
  for (std::size_t v = 0; v < place.size(); ++v) {
    out.points[place[v]] = mesh.points[v];
    for (std::size_t f = 0; f < mesh.fields.size(); ++f) {
      if (isCellField(mesh.fields[f])) continue;
      for (std::size_t c = 0; c < mesh.fields[f].components; ++c) {
        out.values[f][place[v] * mesh.fields[f].components + c] =
            mesh.values[f][v * mesh.fields[f].components + c];
      }
    }
  }
  std::vector<std::size_t> order(mesh.tetrahedra.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::shuffle(order.begin(), order.end(), random);
  for (std::size_t t = 0; t < order.size(); ++t) {
    Tetrahedron cell = mesh.tetrahedra[order[t]];
    for (VertexId& v : cell) v = place[v];
    out.tetrahedra[t] = random() % 2 ? Tetrahedron{cell[1], cell[2], cell[0], cell[3]}
                                     : Tetrahedron{cell[1], cell[0], cell[3], cell[2]};
    for (std::size_t f = 0; f < mesh.fields.size(); ++f) {
      const std::size_t n = mesh.fields[f].components;
      for (std::size_t c = 0; isCellField(mesh.fields[f]) && c < n; ++c)
        out.values[f][t * n + c] = mesh.values[f][order[t] * n + c];
    }
  }
  return out;
}

void expectDifferent(const LatticeMesh& decoded, const LatticeMesh& expected,
                     const std::string& word) {
  const Result<VerifyReport> report = sameMesh(decoded, expected);
  ASSERT_FALSE(report);
  EXPECT_EQ(report.error().code, ErrorCode::kBadValue);
  EXPECT_NE(report.error().message.find(word), std::string::npos) << report.error().message;
}

TEST(SameMesh, numberingDoesNotMatter) {
  const LatticeMesh mesh = small();
  for (std::uint32_t seed = 0; seed < 5; ++seed) {
    const Result<VerifyReport> report = sameMesh(renumbered(mesh, seed), mesh);
    ASSERT_TRUE(report) << report.error().text();
    EXPECT_EQ(report->tetrahedra, mesh.tetrahedra.size());
    EXPECT_EQ(report->interchangeable, 0u);
  }
}

TEST(SameMesh, aMovedVertexIsFound) {
  const LatticeMesh mesh = small();
  for (std::size_t v = 0; v < mesh.points.size(); v += 7) {
    LatticeMesh other = renumbered(mesh, 1);
    ++other.points[v][v % 3];
    expectDifferent(other, mesh, "vertex " + std::to_string(v) + " ");
  }
}

TEST(SameMesh, anotherFieldIntegerIsFound) {
  LatticeMesh other = small();
  --other.values[1][5];
  expectDifferent(other, small(), "vertex 1 ");
}

TEST(SameMesh, anotherCellValueIsFound) {
  LatticeMesh other = small();
  ++other.values[3][2 * 40 + 1];
  expectDifferent(other, small(), "cell 40 of vertex");
}

TEST(SameMesh, twoCellsThatExchangedTheirValuesAreFound) {
  const LatticeMesh mesh = small();
  LatticeMesh other = mesh;
  std::vector<std::int32_t>& regions = other.values[2];
  const auto at =
      std::ranges::find_if(regions, [&](std::int32_t region) { return region != regions[0]; });
  ASSERT_NE(at, regions.end());
  std::swap(regions[0], *at);
  expectDifferent(other, mesh, "with its field values");
}

TEST(SameMesh, anInvertedCellIsFound) {
  const LatticeMesh mesh = small();
  for (std::size_t cell = 0; cell < mesh.tetrahedra.size(); cell += 17) {
    LatticeMesh other = mesh;
    std::swap(other.tetrahedra[cell][0], other.tetrahedra[cell][2]);
    expectDifferent(other, mesh, "cell " + std::to_string(cell) + " ");
  }
}

TEST(SameMesh, anotherVertexInACellIsFound) {
  LatticeMesh other = small();
  other.tetrahedra[20][3] = other.tetrahedra[90][0];
  expectDifferent(other, small(), "cell 20 ");
}

TEST(SameMesh, countsAndFieldsAreCompared) {
  LatticeMesh other = small();
  other.tetrahedra.pop_back();
  expectDifferent(other, small(), "decoded are");
  other = small();
  other.fields[0].name = "Depth";
  expectDifferent(other, small(), "field 0 is Depth");
  other = small();
  other.fields[3].association = "point";
  expectDifferent(other, small(), "components a point");
}

/// A slit: two sheets of points at the same places, each used by the cells of its own side.
LatticeMesh slit() {
  LatticeMesh mesh;
  mesh.points = {{0, 0, 0}, {9, 0, 0}, {0, 9, 0},  {0, 0, 9},    {0, 0, 0},
                 {9, 0, 0}, {0, 9, 0}, {0, 0, -9}, {20, 20, 20}, {20, 20, -20}};
  mesh.tetrahedra = {{0, 1, 2, 3}, {1, 2, 3, 8}, {4, 6, 5, 7}, {5, 7, 6, 9}};
  return mesh;
}

TEST(SameMesh, coincidentPointsAreToldApartByTheirCells) {
  ASSERT_TRUE(sameMesh(renumbered(slit(), 3), slit()));
  LatticeMesh crossed = slit();
  // Every vertex and every cell still has the places it had, but one cell hangs on the other side
  // of the slit.
  crossed.tetrahedra[1][0] = 5;
  expectDifferent(crossed, slit(), "");
}

TEST(SameMesh, trueTwinsAreInterchangeable) {
  LatticeMesh mesh;
  mesh.points = {{0, 0, 0}, {9, 0, 0}, {0, 9, 0}, {0, 0, 9},
                 {0, 0, 0}, {9, 0, 0}, {0, 9, 0}, {0, 0, 9}};
  mesh.tetrahedra = {{0, 1, 2, 3}, {4, 5, 6, 7}};
  const Result<VerifyReport> report = sameMesh(renumbered(mesh, 1), mesh);
  ASSERT_TRUE(report);
  EXPECT_EQ(report->interchangeable, 8u);
}

TEST(PutOnLattice, agreesWithTheQuantiser) {
  const TetMesh mesh = boxSample();
  const Result<QuantisedMesh> quantised = quantise(mesh);
  const Result<OnLattice> put = putOnLattice(mesh, quantised->mesh.lattice, quantised->mesh.fields);
  ASSERT_TRUE(put) << put.error().text();
  EXPECT_EQ(put->mesh.points, quantised->mesh.points);
  EXPECT_EQ(put->mesh.values, quantised->mesh.values);
  EXPECT_LE(put->largestPositionError, 0.5 + 1e-9);
}

TEST(PutOnLattice, fieldsAreFoundByNameAndAssociation) {
  TetMesh mesh = boxSample();
  mesh.fields.push_back({mesh.fields[0].name, 1, "int16", {}, "cell"});
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t)
    mesh.fields[1].values.push_back(static_cast<double>(t % 7) - 3);
  const Result<QuantisedMesh> quantised = quantise(mesh);
  ASSERT_TRUE(quantised);
  const Result<OnLattice> put = putOnLattice(mesh, quantised->mesh.lattice, quantised->mesh.fields);
  ASSERT_TRUE(put) << put.error().text();
  EXPECT_EQ(put->mesh.values, quantised->mesh.values);
  EXPECT_EQ(put->largestFieldErrors[1], 0);
  EXPECT_EQ(quantised->mesh.fields[1].association, "cell");
}

TEST(PutOnLattice, aLatticeOfAnotherMeshIsRefused) {
  const TetMesh mesh = boxSample();
  Lattice lattice = quantise(mesh)->mesh.lattice;
  lattice.origin[1] += lattice.step * 2;
  const Result<OnLattice> put = putOnLattice(mesh, lattice, {});
  ASSERT_FALSE(put);
  EXPECT_EQ(put.error().code, ErrorCode::kBadValue);
}

TEST(PutOnLattice, aFieldThatTheInputLacksIsNotFound) {
  std::vector<FieldInfo> fields = quantise(boxSample())->mesh.fields;
  fields[0].name = "Other";
  const Result<OnLattice> put =
      putOnLattice(boxSample(), quantise(boxSample())->mesh.lattice, fields);
  ASSERT_FALSE(put);
  EXPECT_EQ(put.error().code, ErrorCode::kNotFound);
}

TEST(PutOnLattice, aValueOutsideTheScaleIsRefused) {
  TetMesh mesh = boxSample();
  const Result<QuantisedMesh> quantised = quantise(mesh);
  mesh.fields[0].values[17] += 10;
  EXPECT_FALSE(putOnLattice(mesh, quantised->mesh.lattice, quantised->mesh.fields));
}

TEST(PutOnLattice, aValueBeyondTheErrorThatTheLogStatesIsNamed) {
  const TetMesh mesh = boxSample();
  const Result<QuantisedMesh> quantised = quantise(mesh);
  std::vector<FieldInfo> fields = quantised->mesh.fields;
  // called one value, as by a log that states too little
  fields[0].range = {fields[0].minimum[0], fields[0].minimum[0]};
  const Result<OnLattice> put = putOnLattice(mesh, quantised->mesh.lattice, fields);
  ASSERT_FALSE(put);
  EXPECT_EQ(put.error().code, ErrorCode::kBadValue);
  EXPECT_TRUE(put.error().message.starts_with("field " + fields[0].name + " at point "))
      << put.error().text();
  EXPECT_NE(put.error().message.find(" off what the log holds, and the most is 0;"),
            std::string::npos)
      << put.error().text();
}

}  // namespace
}  // namespace qtet
