// Meshes of OpenFOAM whose lists contradict each other.
#include "simplify/read/foam/poly_mesh.h"

#include <gtest/gtest.h>

#include "tests/simplify/mesh/tet_meshes.h"
#include "tests/simplify/read/foam/foam_files.h"

namespace qtet {
namespace {

namespace fs = std::filesystem;
using testing::freshFolder;
using testing::writeFoam;

Result<CellMesh> meshIn(const fs::path& folder, std::chrono::seconds patience = kReadPatience) {
  CellMesh out;
  if (Status done = readFoamPoints(folder, patience, out); !done)
    return std::unexpected(done.error());
  if (Status done = readPolyMesh(folder, patience, out); !done)
    return std::unexpected(done.error());
  return out;
}

void expectRefusal(const fs::path& folder, const std::string& said) {
  const Result<CellMesh> mesh = meshIn(folder);
  ASSERT_FALSE(mesh) << said;
  EXPECT_EQ(mesh.error().code, ErrorCode::kBadInput);
  EXPECT_NE(mesh.error().message.find(said), std::string::npos) << mesh.error().message;
}

TEST(PolyMesh, cellsAreThoseOfTheirFaces) {
  const fs::path folder = freshFolder("poly-mesh");
  testing::writeTwoCubes(folder);
  const Result<CellMesh> mesh = meshIn(folder);
  ASSERT_TRUE(mesh) << mesh.error().message;
  EXPECT_EQ(mesh->types, (std::vector<std::uint8_t>{kHexahedronCell, kPolyhedronCell}));
  EXPECT_EQ(mesh->points.size(), 14u);
  EXPECT_EQ(mesh->points[12], (Position{2, 0.5, 0}));
  EXPECT_EQ(mesh->pointType, "float64");
  EXPECT_TRUE(checkCellMesh(*mesh, folder));
}

TEST(PolyMesh, ownersOfOneValueAreAsManyAsThereAreFaces) {
  const fs::path folder = freshFolder("uniform-owners");
  for (const char* count : {"3", "5", "16777216"}) {
    testing::writeOneTetrahedron(folder, std::string(count) + "{0}\n");
    EXPECT_FALSE(meshIn(folder)) << count;
  }
  expectRefusal(folder, "at most 4 are possible");
  testing::writeOneTetrahedron(folder, "4{0}\n");
  const Result<CellMesh> mesh = meshIn(folder);
  ASSERT_TRUE(mesh) << mesh.error().message;
  EXPECT_EQ(mesh->types, std::vector<std::uint8_t>{kTetrahedronCell});
  const auto late = meshIn(folder, std::chrono::seconds(-100));
  ASSERT_FALSE(late);
  EXPECT_NE(late.error().message.find("`readSeconds`"), std::string::npos) << late.error().message;
}

TEST(PolyMesh, cornersAndCellsAreWithinTheirLists) {
  const fs::path folder = freshFolder("poly-limits");
  const auto faces = [&](const std::string& last) {
    testing::writeOneTetrahedron(folder);
    writeFoam(folder / "faces", "faceList",
              "4\n(\n3(0 2 1)\n3(0 1 3)\n3(0 3 2)\n" + last + "\n)\n");
  };
  faces("3(1 2 4)");
  expectRefusal(folder, "face 3 has a corner 4 that is none of the 4 points");
  faces("3(1 2 -1)");
  expectRefusal(folder, "face 3 has a corner -1");
  faces("2(1 2)");
  expectRefusal(folder, "face 3 has fewer than three corners");
  faces("3(1 3 2)");
  expectRefusal(folder, "the faces of 1 cells do not close, first those of cell 0");
  testing::writeOneTetrahedron(folder, "4\n(\n0\n0\n0\n4\n)\n");
  expectRefusal(folder, "a cell has number 4, but there are only 4 faces");
  testing::writeOneTetrahedron(folder, "4\n(\n0\n0\n0\n-1\n)\n");
  expectRefusal(folder, "face 3 has no cell");
  testing::writeOneTetrahedron(folder, "3\n(\n0\n0\n0\n)\n");
  expectRefusal(folder, "it has fewer lines than there are faces");
  testing::writeOneTetrahedron(folder, "5\n(\n0\n0\n0\n0\n0\n)\n");
  expectRefusal(folder, "it has 4 faces, but owner has 5 lines");
  testing::writeOneTetrahedron(folder);
  writeFoam(folder / "boundary", "polyBoundaryMesh", "1\n(\nwalls { nFaces 3; }\n)\n");
  expectRefusal(folder, "its patches have 3 faces, but the mesh has 4 at its boundary");
}

TEST(PolyMesh, aPolyhedronOfMoreNumbersThanAreSplitIsRefused) {
  // a prism over a polygon: 1 + 2 (1 + corners) + 5 corners numbers
  for (const std::size_t corners : {2340, 2341}) {
    const fs::path folder = freshFolder("poly-large");
    std::vector<std::string> points, faces, owner(corners + 2, "0");
    std::string low = std::to_string(corners) + "(", high = low;
    for (std::size_t i = 0; i < 2 * corners; ++i)
      points.push_back("(" + std::to_string(i % corners) + " " +
                       std::to_string((i % corners) * (i % corners)) + " " +
                       std::to_string(i / corners) + ")");
    for (std::size_t i = 0; i < corners; ++i) {
      const std::size_t j = (i + 1) % corners;
      low += std::to_string(corners - 1 - i) + " ";
      high += std::to_string(corners + i) + " ";
      faces.push_back("4(" + std::to_string(i) + " " + std::to_string(j) + " " +
                      std::to_string(corners + j) + " " + std::to_string(corners + i) + ")");
    }
    faces.push_back(low + ")");
    faces.push_back(high + ")");
    writeFoam(folder / "points", "vectorField", testing::foamListOf(points));
    writeFoam(folder / "faces", "faceList", testing::foamListOf(faces));
    writeFoam(folder / "owner", "labelList", testing::foamListOf(owner));
    writeFoam(folder / "neighbour", "labelList", "0()\n");
    writeFoam(folder / "boundary", "polyBoundaryMesh",
              "1\n(\nwalls { nFaces " + std::to_string(corners + 2) + "; }\n)\n");
    const Result<CellMesh> mesh = meshIn(folder);
    ASSERT_TRUE(mesh) << mesh.error().message;
    const Status checked = checkCellMesh(*mesh, folder);
    EXPECT_EQ(checked.has_value(), 3 + 7 * corners <= kMaxPolyhedronNumbers) << corners;
    if (!checked) EXPECT_EQ(checked.error().code, ErrorCode::kLimitExceeded);
  }
}

}  // namespace
}  // namespace qtet
