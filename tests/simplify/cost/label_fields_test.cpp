#include "simplify/cost/label_fields.h"

#include <gtest/gtest.h>

#include <set>

#include "codec/mesh/boundary.h"
#include "tests/support/meshes.h"

namespace qtet {
namespace {

/// A grid of cubes of six cells, and a cell field of `type` whose values `valueOf(cell)` tells.
template <class ValueOf>
LatticeMesh meshWith(const std::string& name, const ValueOf& valueOf,
                     const std::string& type = "int32") {
  LatticeMesh mesh = testing::gridMesh(10, 3);
  mesh.fields = {{name, 1, type, "cell", 20, 1, {0}, {0, 1}}};
  mesh.values = {{}};
  for (std::size_t c = 0; c < mesh.tetrahedra.size(); ++c)
    mesh.values[0].push_back(static_cast<std::int32_t>(valueOf(c)));
  return mesh;
}

using Fields = std::vector<std::size_t>;
constexpr std::size_t kSlice = 600;  // a layer of a hundred cubes

TEST(LabelFields, neighboursThatMostlyAgreeMakeALabel) {
  const auto layers = [](std::size_t c) { return c / kSlice; };
  const auto cubes = [](std::size_t c) { return c / 6; };
  EXPECT_EQ(labelsOf(meshWith("f", layers)), Fields{0});
  EXPECT_EQ(labelsOf(meshWith("f", cubes)), Fields{}) << "half of the faces lie inside the cubes";
  EXPECT_EQ(labelsOf(meshWith("f", [](std::size_t c) { return c % 7; })), Fields{});
}

TEST(LabelFields, aUsualNameMakesALabelAndThatOfProcessesNone) {
  const auto cubes = [](std::size_t c) { return c / 6; };
  for (const char* name : {"MaterialIds", "gmsh:physical", "REGION", "BlockId@0.5"})
    EXPECT_EQ(labelsOf(meshWith(name, cubes)), Fields{0}) << name;
  LatticeMesh named = meshWith("f", cubes);
  named.fields[0].labelNames = {{1, "steel"}};
  EXPECT_EQ(labelsOf(named), Fields{0}) << "the file has its names";
  EXPECT_EQ(labelsOf(meshWith("procId", [](std::size_t c) { return c / kSlice; })), Fields{});
}

TEST(LabelFields, aSeriesIsALabelAsAWholeOrNotAtAll) {
  LatticeMesh mesh = meshWith("f@0", [](std::size_t c) { return c / kSlice; });
  mesh.fields.push_back(mesh.fields[0]);
  mesh.fields[1].name = "f@1";
  mesh.values.emplace_back(mesh.values[0].size(), 7);  // constant
  EXPECT_EQ(labelsOf(mesh), (Fields{0, 1}));
  mesh.fields[1].type = "float32";
  EXPECT_EQ(labelsOf(mesh), Fields{});
}

TEST(LabelFields, namesOfValuesThatAreNotThereAreLeftOut) {
  FieldInfo info{"f", 1, "int64", "cell", 4, 1, {5e9}, {0, 1}};
  info.labelNames = {{1, "a"}, {705032704, "5e9 modulo 2^32"}};
  EXPECT_EQ(namesOfValues(info, {0, 1}), LabelNames{});
  info.minimum = {0};
  EXPECT_EQ(namesOfValues(info, {0, 1}), (LabelNames{{1, "a"}}));
}

TEST(LabelFields, onlyExactIntegersOfFewValuesCanBeOne) {
  const auto values = [](std::size_t most) { return [most](std::size_t c) { return c % most; }; };
  EXPECT_TRUE(canBeLabel(meshWith("f", values(2)), 0));
  EXPECT_FALSE(canBeLabel(meshWith("f", values(1)), 0)) << "a constant";
  EXPECT_TRUE(canBeLabel(meshWith("f", values(kMaxLabelValues)), 0));
  EXPECT_FALSE(canBeLabel(meshWith("f", values(kMaxLabelValues + 1)), 0));
  EXPECT_FALSE(canBeLabel(meshWith("f", values(2), "float32"), 0));
  LatticeMesh rounded = meshWith("f", values(2));
  rounded.fields[0].step = 2;
  EXPECT_FALSE(canBeLabel(rounded, 0));
  LatticeMesh ofPoints = testing::gridMesh(3, 3);
  EXPECT_FALSE(canBeLabel(ofPoints, 0));
}

TEST(LabelFields, interfacesFaceAwayFromTheLowerLabel) {
  const LatticeMesh mesh = meshWith("f", [](std::size_t c) { return c < 5 * kSlice ? 7 : 3; });
  const std::vector<Triangle> interfaces = interfacesOf(mesh, 0);
  ASSERT_EQ(interfaces.size(), 200u) << "two triangles a square";
  std::set<std::array<VertexId, 3>> ofLower;
  for (std::size_t c = 5 * kSlice; c < mesh.tetrahedra.size(); ++c)
    for (int corner = 0; corner < 4; ++corner) ofLower.insert(cellFace(mesh.tetrahedra[c], corner));
  for (const Triangle& t : interfaces) EXPECT_TRUE(ofLower.contains(t));
}

}  // namespace
}  // namespace qtet
