// Files of meshes whose numbers are beyond a format.
#include "codec/files/mesh_file.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <set>
#include <string>

#include "codec/files/file_names.h"
#include "proto/limits.h"

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

/// One tetrahedron with a field `name` of points and of cells.
Result<Bytes> fileOfField(const std::string& name, std::uint32_t components,
                          std::string_view ending) {
  const std::vector<std::array<double, 3>> points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const std::vector<Tetrahedron> tetrahedra = {{0, 1, 2, 3}};
  FileMesh mesh{points, tetrahedra, true, {}, {}};
  mesh.pointFields = {{name, "float32", components, std::vector<double>(4 * components, 1.0)}};
  mesh.cellFields = {{name, "float32", components, std::vector<double>(components, 1.0)}};
  return meshFileBytes(mesh, ending);
}

void expectRefused(const Result<Bytes>& bytes, const std::string& figure) {
  ASSERT_FALSE(bytes) << figure;
  EXPECT_EQ(bytes.error().code, ErrorCode::kBadInput);
  for (const std::string& said : {figure, std::string("at most"), std::string("`fields`")})
    EXPECT_NE(bytes.error().message.find(said), std::string::npos) << bytes.error().message;
}

TEST(MeshFile, aNameThatAFormatsOwnProgramDoesNotReadWholeIsRefused) {
  for (const std::size_t bytes : {1u, 251u, 252u, 253u, 255u, 256u}) {
    const std::string name(bytes, 'n');
    for (const char* ending : {".vtu", ".usda", ".obj"})
      EXPECT_TRUE(fileOfField(name, 1, ending)) << ending;
    if (bytes <= 252)
      EXPECT_TRUE(fileOfField(name, 1, ".msh")) << bytes;
    else
      expectRefused(fileOfField(name, 1, ".msh"), std::to_string(bytes) + " bytes");
    if (bytes <= 255)
      EXPECT_TRUE(fileOfField(name, 1, ".vtk")) << bytes;
    else
      expectRefused(fileOfField(name, 1, ".vtk"), "256 bytes");
  }
}

TEST(MeshFile, aLegacyVtkNameCountsAsVtkEncodesIt) {
  EXPECT_TRUE(fileOfField(std::string(85, ' '), 1, ".vtk"));  // three characters each
  expectRefused(fileOfField(std::string(86, ' '), 1, ".vtk"), "258 bytes");
}

TEST(MeshFile, moreComponentsThanGmshShowsAreRefused) {
  EXPECT_TRUE(fileOfField("tensor", 9, ".msh"));
  expectRefused(fileOfField("matrix", 10, ".msh"), "10 components");
  for (const char* ending : {".vtu", ".vtk", ".usda", ".obj"})
    EXPECT_TRUE(fileOfField("matrix", 16, ending)) << ending;
}

TEST(MeshFile, identifiersOfAlikeNamesDifferAndStayShort) {
  std::set<std::string> taken;
  EXPECT_EQ(newIdentifier("T@1", taken), "T_1");
  EXPECT_EQ(newIdentifier("T#1", taken), "T_1_");
  EXPECT_EQ(newIdentifier("T 1", taken), "T_1__");
  for (std::uint32_t i = 3; i < kMaxFields; ++i)
    EXPECT_LE(newIdentifier("T.1", taken).size(), std::string("T_1____8192").size());
  EXPECT_EQ(taken.size(), kMaxFields);
}

/// Times that `text` stands in the file.
std::size_t timesIn(const Bytes& file, std::string_view text) {
  std::size_t out = 0;
  for (auto at = file.begin();
       (at = std::search(at, file.end(), text.begin(), text.end())) != file.end(); ++at)
    ++out;
  return out;
}

TEST(MeshFile, asManyFieldsAsALogMayHaveStandInEveryFormatWithFieldsOfCells) {
  const std::vector<std::array<double, 3>> points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const std::vector<Tetrahedron> tetrahedra = {{0, 1, 2, 3}};
  FileMesh mesh{points, tetrahedra, true, {}, {}};
  for (std::uint32_t f = 0; f < kMaxFields; ++f)
    mesh.pointFields.push_back(
        {"f" + std::to_string(f), "float32", 1, std::vector<double>(4, double{1} * f)});
  for (const auto& [ending, each] : {std::pair{".vtu", "<DataArray type=\"Float32\" Name=\"f"},
                                     {".vtk", " 1 4 float\n"},
                                     {".msh", "$NodeData\n"},
                                     {".usda", "    def TetMesh"}}) {
    const Result<Bytes> bytes = meshFileBytes(mesh, ending);
    ASSERT_TRUE(bytes) << ending << bytes.error().text();
    EXPECT_EQ(timesIn(*bytes, each), std::string_view(ending) == ".usda" ? 1 : kMaxFields)
        << ending;
  }
}

}  // namespace
}  // namespace qtet
