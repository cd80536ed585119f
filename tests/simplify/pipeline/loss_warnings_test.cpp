#include "simplify/pipeline/loss_warnings.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <utility>

#include "simplify/pipeline/pipeline.h"

namespace qtet {
namespace {

using Place = std::function<Position(double x, double y, double z)>;

/// Adds sides[0] x sides[1] x sides[2] cubes of six cells each, with points of their own; `place`
/// moves each point of the unit cube.
void addBlock(TetMesh& mesh, const std::array<int, 3>& sides, const Place& place) {
  const auto first = static_cast<VertexId>(mesh.points.size());
  const auto [nx, ny, nz] = sides;
  const auto at = [&](const std::array<int, 3>& p) {
    return first + static_cast<VertexId>(p[0] + (nx + 1) * (p[1] + (ny + 1) * p[2]));
  };
  for (int k = 0; k <= nz; ++k)
    for (int j = 0; j <= ny; ++j)
      for (int i = 0; i <= nx; ++i)
        mesh.points.push_back(place(1.0 * i / nx, 1.0 * j / ny, 1.0 * k / nz));
  for (int k = 0; k < nz; ++k)
    for (int j = 0; j < ny; ++j)
      for (int i = 0; i < nx; ++i) {
        std::array<std::size_t, 3> order{0, 1, 2};
        do {
          std::array<int, 3> p{i, j, k};
          Tetrahedron t{at(p)};
          for (std::size_t s = 0; s < 3; ++s) ++p[order[s]], t[s + 1] = at(p);
          mesh.tetrahedra.push_back(t);
        } while (std::next_permutation(order.begin(), order.end()));
      }
}

/// The cube as a ball of radius 1.
Position onBall(double x, double y, double z) {
  const Position p{2 * x - 1, 2 * y - 1, 2 * z - 1};
  const double length = std::hypot(p[0], p[1], p[2]),
               most = std::max({std::abs(p[0]), std::abs(p[1]), std::abs(p[2])});
  const double scale = length > 0 ? most / length : 0;
  return {p[0] * scale, p[1] * scale, p[2] * scale};
}

TetMesh ball(int side) {
  TetMesh mesh;
  addBlock(mesh, {side, side, side}, onBall);
  return mesh;
}

std::vector<std::string> warningsOf(TetMesh mesh, const PipelineOptions& options) {
  const Result<PipelineOutput> made = simplifyToLog(std::move(mesh), options);
  EXPECT_TRUE(made) << made.error().text();
  return made ? made->report.warnings : std::vector<std::string>{"none was made"};
}

std::vector<std::string> warningsOf(TetMesh mesh, double targetRatio) {
  PipelineOptions options;
  options.fusion.targetRatio = targetRatio;
  return warningsOf(std::move(mesh), options);
}

void expectWarning(const std::vector<std::string>& warnings,
                   const std::vector<std::string>& words) {
  ASSERT_EQ(warnings.size(), 1u);
  for (const std::string& word : words)
    EXPECT_NE(warnings[0].find(word), std::string::npos) << word << " is not in: " << warnings[0];
}

/// The text behind the words, up to the next space.
std::string after(const std::string& words, const std::string& text) {
  const std::size_t at = text.find(words);
  EXPECT_NE(at, std::string::npos) << words << " is not in: " << text;
  return at == std::string::npos
             ? ""
             : text.substr(at + words.size(),
                           text.find(' ', at + words.size()) - at - words.size());
}

/// The number of cells that a warning tells to give takes it away, and half of it does not.
void expectItsAdviceToHelp(const TetMesh& mesh, PipelineOptions options) {
  const std::vector<std::string> warnings = warningsOf(mesh, options);
  ASSERT_EQ(warnings.size(), 1u);
  const std::size_t cells = std::stoul(after("give `baseCells` ", warnings[0]));
  options.fusion.targetRatio.reset();
  options.fusion.baseCells = cells;
  EXPECT_EQ(warningsOf(mesh, options), std::vector<std::string>{});
  options.fusion.baseCells = cells / 2;
  EXPECT_EQ(warningsOf(mesh, options).size(), 1u) << "fewer cells would do";
}

/// A wave of 24 x 24 cubes that is one thick.
TetMesh thinWave() {
  TetMesh mesh;
  addBlock(mesh, {24, 24, 1}, [](double x, double y, double z) {
    return Position{x, y, 0.1 * std::sin(9 * x) * std::cos(9 * y) + 0.02 * z};
  });
  return mesh;
}

TEST(LossWarnings, anOrdinaryMeshHasNone) {
  EXPECT_EQ(warningsOf(ball(8), 0.5), std::vector<std::string>{});
  EXPECT_EQ(warningsOf(ball(8), PipelineOptions()), std::vector<std::string>{});
  EXPECT_EQ(warningsOf(thinWave(), PipelineOptions()), std::vector<std::string>{});
}

TEST(LossWarnings, aLabelThatIsWrongInMuchOfTheVolumeIsNamed) {
  TetMesh mesh = ball(8);
  MeshField grain{"Grain", 1, "int32", {}, "cell"};
  for (std::size_t c = 0; c < mesh.tetrahedra.size(); ++c)
    grain.values.push_back(static_cast<double>(c / 12 % 40));
  mesh.fields.push_back(grain);
  PipelineOptions options;
  options.fusion.targetRatio = 0.5;
  options.labelWeights = {{"Grain", 1}};
  const std::vector<std::string> warnings = warningsOf(mesh, options);
  ASSERT_FALSE(warnings.empty());
  expectWarning({warnings.back()}, {" % of the volume of the base mesh have another label Grain",
                                    "give `baseCells` ", "`labelWeights`"});
  options.labelWeights = {{"Grain", 0}};
  for (const std::string& warning : warningsOf(mesh, options))
    EXPECT_FALSE(warning.contains("Grain")) << "it is no label";
  options.labelWeights = {{"grain", 1}};
  const Result<PipelineOutput> unknown = simplifyToLog(TetMesh(mesh), options);
  ASSERT_FALSE(unknown);
  EXPECT_EQ(unknown.error().code, ErrorCode::kNotFound);
}

TEST(LossWarnings, tooFewCellsAreTheReasonWhereNothingElseIs) {
  expectWarning(warningsOf(ball(8), 0.01),
                {"has lost ", " % of the volume", "too few cells are left for this shape",
                 " in place of `targetRatio`"});
  PipelineOptions options;
  options.fusion.targetRatio = 0.01;
  expectItsAdviceToHelp(ball(8), options);
}

TEST(LossWarnings, piecesThatAreNotJoinedAreTheReason) {
  TetMesh mesh;
  for (const double x : {0.0, 0.5})
    for (const double y : {0.0, 0.5})
      addBlock(mesh, {6, 6, 12},
               [&](double u, double v, double w) { return onBall(x + u / 2, y + v / 2, w); });
  expectWarning(warningsOf(std::move(mesh), 0.004),
                {"points lie at the place of another one", "`weld` 0"});
}

TEST(LossWarnings, manyPartsAreTheReason) {
  TetMesh mesh;
  for (int part = 0; part < 27; ++part)
    addBlock(mesh, {3, 3, 3}, [&](double x, double y, double z) {
      const Position p = onBall(x, y, z);
      const int row = part / 3 % 3, layer = part / 9;
      return Position{p[0] + 3 * (part % 3), p[1] + 3 * row, p[2] + 3 * layer};
    });
  PipelineOptions options;
  options.fusion.targetRatio = 0.01;
  expectWarning(warningsOf(mesh, options), {"falls into 27 parts", "`weld` DISTANCE"});
  expectItsAdviceToHelp(mesh, options);
}

TEST(LossWarnings, thinWallsAreTheReason) {
  PipelineOptions options;
  options.fusion.targetRatio = 0.01;
  expectWarning(warningsOf(thinWave(), options), {"its walls are thin"});
  expectItsAdviceToHelp(thinWave(), options);
}

Manifest manifestOf(double net, double boundary) {
  Manifest manifest;
  manifest.levels = {{0, 10, 10, 10, 0, std::nullopt}, {1, 1000, 1000, 500, 1, std::nullopt}};
  manifest.levels[0].error.emplace();
  manifest.levels[0].error->volumeLost = std::max(-net, 0.0);
  manifest.levels[0].error->volumeGained = std::max(net, 0.0);
  manifest.levels[0].error->toOriginal.max = boundary;
  return manifest;
}

TEST(LossWarnings, beginAboveTheLimitsOnly) {
  const CleanReport clean;
  const LossFacts facts{clean, 0.2};
  EXPECT_TRUE(lossWarnings(manifestOf(-0.0199, 0.02), facts).empty());
  EXPECT_TRUE(lossWarnings(manifestOf(0.0199, 0.02), facts).empty());
  expectWarning(lossWarnings(manifestOf(-0.05, 0), facts), {"has lost 5 % of the volume"});
  expectWarning(lossWarnings(manifestOf(0.05, 0), facts), {"has gained 5 % of the volume"});
  expectWarning(lossWarnings(manifestOf(0, 0.03), facts), {"up to 3 % of the diagonal off"});
  EXPECT_TRUE(lossWarnings(manifestOf(0, 0.03), {clean, 0.2, 0.04}).empty())
      << "the user allowed it";
  expectWarning(lossWarnings(manifestOf(-0.05, 0), {clean, 0.2, 0, false, true}),
                {"`baseCells` 1000 (unasked it takes 64 kB or 30000 tetrahedra at most)"});
  Manifest unmeasured = manifestOf(-0.5, 0.5);
  unmeasured.levels[0].error.reset();
  EXPECT_TRUE(lossWarnings(unmeasured, facts).empty());
}

TEST(WallThickness, isTwiceTheVolumeOverTheArea) {
  LatticeMesh mesh;
  mesh.points = {{0, 0, 0}, {6, 0, 0}, {0, 6, 0}, {0, 0, 6}};
  mesh.boundary = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};
  const double area = 3 * 18 + std::sqrt(3.0) / 4 * 72;
  EXPECT_NEAR(wallThicknessOf(mesh), 2 * 36 / area / std::sqrt(108.0), 1e-12);
  EXPECT_EQ(wallThicknessOf({}), 0);
}

}  // namespace
}  // namespace qtet
