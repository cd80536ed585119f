#include "simplify/read/vtu/old_hexahedra.h"

#include <gtest/gtest.h>

#include <numeric>
#include <string>

#include "simplify/mesh/volume_sign.h"
#include "simplify/read/read_mesh.h"
#include "simplify/split/higher_cells.h"
#include "simplify/split/node_order.h"
#include "tests/simplify/mesh/tet_meshes.h"
#include "tests/simplify/read/vtu/vtk_written.h"

namespace qtet {
namespace {

using testing::fileWith;

constexpr Degrees kSquare{2, 2, 2};

/// The corners and nodes of a cube of edge 2, in the order of VTK 9 or before it.
std::string cubeNodes(bool isOld) {
  std::string places[27];
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      for (int k = 0; k < 3; ++k)
        places[hexahedronNode(kSquare, i, j, k)] =
            std::to_string(i) + " " + std::to_string(j) + " " + std::to_string(k) + "\n";
  if (isOld) std::swap(places[18], places[19]);
  std::string out;
  for (const std::string& place : places) out += place;
  return out;
}

std::string upTo(int count) {
  std::string out;
  for (int i = 0; i < count; ++i) out += std::to_string(i) + " ";
  return out;
}

std::string vtuFile(const std::string& version, int type, bool isOld) {
  const auto array = [](const std::string& what, const std::string& values) {
    return "<DataArray format='Ascii' " + what + ">" + values + "</DataArray>";
  };
  return "<VTKFile type='UnstructuredGrid' " + version +
         " byte_order='LittleEndian'><UnstructuredGrid><Piece NumberOfPoints='27' "
         "NumberOfCells='1'><Points>" +
         array("type='Float64' Name='Points' NumberOfComponents='3'", cubeNodes(isOld)) +
         "</Points><Cells>" + array("type='Int64' Name='connectivity'", upTo(27)) +
         array("type='Int64' Name='offsets'", "27") +
         array("type='UInt8' Name='types'", std::to_string(type)) +
         "</Cells></Piece></UnstructuredGrid></VTKFile>";
}

std::string legacyFile(const std::string& version, bool isOld) {
  const std::string cells = version < "5" ? "CELLS 1 28\n27 " + upTo(27)
                                          : "CELLS 2 27\nOFFSETS vtktypeint64\n0 27\n"
                                            "CONNECTIVITY vtktypeint64\n" +
                                                upTo(27);
  return "# vtk DataFile Version " + version +
         "\ncube\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 27 double\n" + cubeNodes(isOld) + cells +
         "\nCELL_TYPES 1\n72\n";
}

/// A cube of eight cubes of 6 tetrahedra of the same volume, if its nodes are where they belong.
void expectACube(const std::filesystem::path& path, const std::string& what) {
  const Result<ReadMesh> read = readMesh(path);
  ASSERT_TRUE(read) << what << ": " << read.error().text();
  EXPECT_EQ(read->mesh.tetrahedra.size(), 48u) << what;
  for (const Tetrahedron& cell : read->mesh.tetrahedra) {
    const auto& p = read->mesh.points;
    EXPECT_DOUBLE_EQ(roundedVolume6(p[cell[0]], p[cell[1]], p[cell[2]], p[cell[3]]), 1) << what;
  }
}

TEST(OldHexahedra, filesOfVtk8HaveTwoEdgesTheOtherWayRound) {
  for (const auto& [version, isOld] :
       {std::pair("", true), std::pair("version='0.1'", true), std::pair("version='1.0'", true),
        std::pair("version='2.0'", true), std::pair("version='2.1'", false),
        std::pair("version='2.2'", false)})
    for (const int type : {72, 79}) {
      const auto path = fileWith("cube.vtu", vtuFile(version, type, isOld));
      expectACube(path, version);
      testing::expectSame(testing::readByOurs(path), testing::readByVtk(path), version);
    }
  for (const auto& [version, isOld] : {std::pair("3.0", true), std::pair("4.2", true),
                                       std::pair("5.0", true), std::pair("5.1", false)})
    expectACube(fileWith("cube.vtk", legacyFile(version, isOld)), version);
}

TEST(OldHexahedra, versionsAreComparedByNumbers) {
  EXPECT_TRUE(isOlderVersion("2.0", "2.1"));
  EXPECT_FALSE(isOlderVersion("2.1", "2.1"));
  EXPECT_FALSE(isOlderVersion("2.10", "2.1"));
  EXPECT_FALSE(isOlderVersion("10.0", "2.1"));
  EXPECT_TRUE(isOlderVersion("2", "2.1"));
  EXPECT_TRUE(isOlderVersion("", "2.1"));
}

TEST(OldHexahedra, degreesThatDifferByDirectionAreThoseStated) {
  CellMesh mesh;
  std::vector<VertexId> ids(16);  // of degrees 1, 1, 3
  std::iota(ids.begin(), ids.end(), 0u);
  mesh.addCell(kLagrangeHexahedronCell, ids);
  mesh.fields.push_back({kDegreesField, 3, "int32", {1, 1, 3}, "cell"});
  renumberOldHexahedra(mesh);
  EXPECT_EQ(mesh.vertices,
            (std::vector<VertexId>{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 14, 15, 12, 13}));
  // without them no hexahedron has 16 nodes
  mesh.fields.clear();
  mesh.vertices = ids;
  renumberOldHexahedra(mesh);
  EXPECT_EQ(mesh.vertices, ids);
}

}  // namespace
}  // namespace qtet
