#include "simplify/pipeline/fusion_choice.h"

#include <gtest/gtest.h>

#include "tests/simplify/pipeline/field_meshes.h"

namespace qtet {
namespace {

/// The weights of T at three times, and of Swirl, where a viewer opens with `opened`.
std::vector<double> weightsBy(const PipelineOptions& options, std::size_t opened) {
  TetMesh mesh = boxSample();
  mesh.fields[0].name = "T@0";
  mesh = testing::boxWithFields(std::move(mesh));
  for (const char* const name : {"T@1", "T@2"}) {
    mesh.fields.push_back(mesh.fields[0]);
    mesh.fields.back().name = name;
  }
  std::vector<std::string> notes;
  const Result<QuantisedMesh> quantised = quantise(mesh);
  EXPECT_TRUE(quantised);
  const auto chosen = fusionOptionsFor(options, *quantised, opened, notes);
  EXPECT_TRUE(chosen);
  const std::vector<double>& all = chosen->cost.fieldWeights;  // Label and Height are of cells
  return {all[0], all[4], all[5], all[1]};
}

TEST(FusionChoice, whatAViewerOpensWithCountsDouble) {
  using Weights = std::vector<double>;
  PipelineOptions options;
  EXPECT_EQ(weightsBy(options, 0), (Weights{2, 2, 2, 1})) << "all instants of a series";
  EXPECT_EQ(weightsBy(options, 1), (Weights{1, 1, 1, 2}));
  EXPECT_EQ(weightsBy(options, 3), (Weights{1, 1, 1, 1})) << "a field of cells has no weight";
  options.fieldWeights = {{"Swirl", 1}};
  EXPECT_EQ(weightsBy(options, 0), (Weights{1, 1, 1, 1})) << "where somebody says";
}

TEST(FusionChoice, thePipelineAsksForWhatTheLogOpensWith) {
  TetMesh mesh = boxSample();
  mesh.fields.insert(mesh.fields.begin(), mesh.fields[0]);
  mesh.fields[0].name = "Halves";  // two colours
  for (std::size_t i = 0; i < mesh.points.size(); ++i)
    mesh.fields[0].values[i] = mesh.points[i][2] > 0.4 ? 1 : 0;
  PipelineOptions options;
  const auto madeBy = [&] { return simplifyToLog(TetMesh(mesh), options).value(); };
  const PipelineOutput unasked = madeBy();
  ASSERT_TRUE(unasked.report.manifest.opening && unasked.report.manifest.opening->field == 1);
  options.fieldWeights = {{"Scalar", 2}};
  EXPECT_EQ(madeBy().log.head, unasked.log.head);
  options.fieldWeights = {{"Scalar", 1}};
  EXPECT_NE(madeBy().log.head, unasked.log.head);
}

}  // namespace
}  // namespace qtet
