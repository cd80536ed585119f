#include "simplify/pipeline/fusion_choice.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "simplify/cost/boundary_weight.h"
#include "simplify/cost/expected_error.h"
#include "tests/simplify/pipeline/field_meshes.h"

namespace qtet {
namespace {

/// The choice for T at three times, Swirl, and the constant One.
CostOptions costBy(const PipelineOptions& options, QuantisedMesh& quantised) {
  TetMesh mesh = boxSample();
  mesh.fields[0].name = "T@0";
  mesh = testing::boxWithFields(std::move(mesh));
  for (const char* const name : {"T@1", "T@2", "One"}) {
    mesh.fields.push_back(mesh.fields[0]);
    mesh.fields.back().name = name;
  }
  std::ranges::fill(mesh.fields.back().values, 1);
  std::vector<std::string> notes;
  quantised = quantise(mesh).value();
  const auto chosen = fusionOptionsFor(options, LatticeFigures(quantised.mesh), notes);
  EXPECT_TRUE(chosen);
  return chosen->cost;
}

TEST(FusionChoice, balancesFieldsAndBoundaryWhereNobodySays) {
  QuantisedMesh quantised;
  const CostOptions cost = costBy({}, quantised);
  const std::vector<double>& weights = cost.fieldWeights;
  const double t = weights[0];
  EXPECT_GT(t, 0);
  EXPECT_EQ(weights, (std::vector{t, weights[1], 0.0, 0.0, t, t, 0.0})) << "Label, Height, One: 0";
  EXPECT_NE(t, weights[1]);
  EXPECT_EQ(std::min(t, weights[1]), 1);
  const std::vector<CostPart> parts = costPartsOf(quantised.mesh, weights);
  const double boundary =
      balancedBoundaryWeight(quantised.mesh, parts, expectedFieldErrors(quantised.mesh, parts));
  EXPECT_NEAR(cost.boundaryWeight.value(), boundary, 1e-12 * boundary);
}

TEST(FusionChoice, takesTheWeightsThatSomebodySays) {
  QuantisedMesh quantised;
  PipelineOptions options;
  options.fieldWeights = {{"Swirl", 1}};
  EXPECT_EQ(costBy(options, quantised).fieldWeights, (std::vector<double>{1, 1, 0, 0, 1, 1, 0}));
  options.fieldWeights = {{"T", 3}};
  EXPECT_EQ(costBy(options, quantised).fieldWeights, (std::vector<double>{3, 1, 0, 0, 3, 3, 0}));
}

}  // namespace
}  // namespace qtet
