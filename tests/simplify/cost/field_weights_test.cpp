#include "simplify/cost/field_weights.h"

#include <gtest/gtest.h>

namespace qtet {
namespace {

using Weights = std::vector<double>;

/// A mesh without points; the cells' field never counts.
LatticeMesh meshWith(const std::vector<std::string>& pointFields) {
  LatticeMesh mesh;
  mesh.fields.push_back({"ofCells", 1, "float32", "cell", 12, 1, {0}, {0, 1}});
  for (const std::string& name : pointFields)
    mesh.fields.push_back({name, 1, "float32", "point", 12, 1, {0}, {0, 1}});
  return mesh;
}

Weights weightsBy(const std::vector<std::string>& names, const std::vector<double>& errors) {
  std::vector<CostPart> parts;
  for (std::size_t f = 1; f <= names.size(); ++f) parts.push_back({f, 1});
  return balancedFieldWeights(meshWith(names).fields, parts, errors);
}

TEST(FieldWeights, fallWithTheExpectedError) {
  EXPECT_EQ(weightsBy({"a", "b", "c"}, {0.5, 0.125, 0.03125}), (Weights{0, 1, 2, 4}));
}

TEST(FieldWeights, areEightAtMost) {
  EXPECT_EQ(weightsBy({"rough", "a"}, {49, 1}), (Weights{0, 1, 7}));
  EXPECT_EQ(weightsBy({"rough", "a", "b"}, {64, 1, 0.5}), (Weights{0, 1, 8, 8}));
  EXPECT_EQ(weightsBy({"rough", "linear", "rounded"}, {1, 0, -1e-9}), (Weights{0, 1, 8, 8}));
  EXPECT_EQ(weightsBy({"linear", "straight"}, {0, 0}), (Weights{0, 1, 1}));
}

TEST(FieldWeights, areOneForAllInstantsOfASeries) {
  EXPECT_EQ(weightsBy({"T@0", "p", "T@1"}, {0, 4, 0.5}), (Weights{0, 4, 1, 4}));
}

}  // namespace
}  // namespace qtet
