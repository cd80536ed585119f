// Files of meshes whose numbers are beyond a format.
#include "codec/files/mesh_file.h"

#include <gtest/gtest.h>

#include <limits>

namespace qtet {
namespace {

/// One tetrahedron with edges of `size`.
Result<Bytes> tetrahedronFile(double size, std::string_view ending) {
  const std::vector<std::array<double, 3>> points = {
      {0, 0, 0}, {size, 0, 0}, {0, size, 0}, {0, 0, size}};
  const std::vector<Tetrahedron> tetrahedra = {{0, 1, 2, 3}};
  return meshFileBytes(FileMesh{points, tetrahedra, true, {}, {}}, ending);
}

TEST(MeshFile, coordinatesBeyondFloatsAreRefusedWhereAFormatKnowsNoOther) {
  constexpr double kMax = std::numeric_limits<float>::max();
  EXPECT_TRUE(tetrahedronFile(kMax, ".usda"));
  EXPECT_TRUE(tetrahedronFile(-kMax, ".usda"));
  for (const double size : {1.01 * kMax, -1e308}) {
    const Result<Bytes> refused = tetrahedronFile(size, ".usda");
    ASSERT_FALSE(refused) << size;
    EXPECT_EQ(refused.error().code, ErrorCode::kBadInput);
    EXPECT_NE(refused.error().message.find(".usda"), std::string::npos) << refused.error().message;
  }
  for (const char* ending : {".vtu", ".vtk", ".msh", ".obj"})
    EXPECT_TRUE(tetrahedronFile(1e308, ending)) << ending;
}

}  // namespace
}  // namespace qtet
