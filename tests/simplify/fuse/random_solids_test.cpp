// Whatever the solid, every level of its history is a solid of the same topology: inside the
// original, or within the envelope's tolerance of it. Its log brings all of it back.
// QTET_RANDOM_SOLIDS=N tries N more seeds.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <map>
#include <string>
#include <utility>

#include "codec/files/atomic_file.h"
#include "codec/log/log_writer.h"
#include "codec/refine/log_file.h"
#include "simplify/clean/verify.h"
#include "simplify/fuse/qtetfusion.h"
#include "simplify/parts/parts_simplify.h"
#include "tests/simplify/parts/small_parts.h"
#include "tests/support/meshes.h"
#include "tests/support/random_solid.h"
#include "tests/support/solid_check.h"

namespace qtet {
namespace {

using testing::checkSolid;
using testing::freshFolder;
using testing::meshOfHistory;
using testing::randomSolid;
using testing::SolidReport;
using testing::topologyChange;
using testing::whatIsOutside;

constexpr std::uint32_t kSeeds = 16;

double latticeDiagonal(const LatticeMesh& mesh) {
  LatticePoint low = mesh.points[0], high = low;
  for (const LatticePoint& p : mesh.points)
    for (std::size_t k = 0; k < 3; ++k)
      low[k] = std::min(low[k], p[k]), high[k] = std::max(high[k], p[k]);
  return std::hypot(high[0] - low[0], high[1] - low[1], high[2] - low[2]);
}

void everyLevelKeepsItsPromises(const LatticeMesh& mesh, const FusionHistory& history) {
  const SolidReport original = checkSolid(mesh);
  ASSERT_EQ(original.faults(), "") << "the input itself";
  std::int64_t coarser = 0;
  for (std::uint32_t undone = 0; undone <= history.levels; ++undone) {
    SCOPED_TRACE("level " + std::to_string(undone) + " of " + std::to_string(history.levels));
    const LatticeMesh level = meshOfHistory(history, undone);
    const SolidReport now = checkSolid(level);
    ASSERT_EQ(now.faults(), "");
    ASSERT_EQ(topologyChange(now, original), "");
    ASSERT_EQ(whatIsOutside(level, mesh), "");
    ASSERT_GE(now.volume6, coarser) << "less than the coarser level before it";
    coarser = now.volume6;
  }
  EXPECT_EQ(coarser, original.volume6);
}

void itsLogDecodesToTheSame(const LatticeMesh& mesh, const FusionHistory& history) {
  LogWriterOptions options;
  options.chunkBytes = 400;  // several chunks, most of which end inside a level
  const auto encoded = encodeLog(history, options);
  ASSERT_TRUE(encoded) << encoded.error().text();
  const auto path = freshFolder("random-solid") / "solid.qtet";
  ASSERT_TRUE(writeFileAtomically(path, encoded->bytes));
  const auto log = LogFile::open(path);
  ASSERT_TRUE(log) << log.error().text();
  for (const std::uint32_t level : {0u, history.levels / 2, history.levels}) {
    const auto decoded = meshAtLevel(*log, level);
    ASSERT_TRUE(decoded) << decoded.error().text();
    const auto same =
        sameMesh(*decoded, level == history.levels ? mesh : meshOfHistory(history, level));
    EXPECT_TRUE(same) << "level " << level << ": " << same.error().text();
  }
}

using Simplify = Result<FusionHistory> (*)(const LatticeMesh& mesh, const FusionOptions& options);
Result<FusionHistory> inOnePiece(const LatticeMesh& mesh, const FusionOptions& options) {
  return simplify(mesh, options);
}
Result<FusionHistory> inParts(const LatticeMesh& mesh, const FusionOptions& options) {
  LatticeMesh copy = mesh;
  Result<PartsFusion> fused = simplifyInParts(std::move(copy), options, testing::smallParts(100));
  if (!fused) return std::unexpected(fused.error());
  return std::move(fused->history);
}

void keepsItsPromises(std::uint32_t seed, Simplify simplifies) {
  const auto solid = randomSolid(seed);
  SCOPED_TRACE("seed " + std::to_string(seed) + ": " + solid.description);
  FusionOptions options;
  options.targetRatio = 0;
  options.envelopeTolerance = 0;
  const auto history = simplifies(solid.mesh, options);
  ASSERT_TRUE(history) << history.error().text();
  everyLevelKeepsItsPromises(solid.mesh, *history);
  if (!::testing::Test::HasFatalFailure()) itsLogDecodesToTheSame(solid.mesh, *history);
}

/// With room outside: a solid of the same topology that nowhere meets itself, and its boundary
/// within the tolerance.
void keepsItsPromisesOutside(std::uint32_t seed, Simplify simplifies) {
  const auto solid = randomSolid(seed);
  SCOPED_TRACE("seed " + std::to_string(seed) + ": " + solid.description);
  FusionOptions options;
  options.targetRatio = 0;
  const double share = std::array{kEnvelopeTolerance, 0.01, 0.05, 0.3}[seed % 4];
  options.envelopeTolerance = share;
  options.placement = seed % 3 == 0 ? PlacementRule::kAuto : PlacementRule::kOptimal;
  const auto history = simplifies(solid.mesh, options);
  ASSERT_TRUE(history) << history.error().text();
  const SolidReport original = checkSolid(solid.mesh);
  const double tolerance = share * latticeDiagonal(solid.mesh);
  for (std::uint32_t undone = 0; undone <= history->levels; ++undone) {
    SCOPED_TRACE("level " + std::to_string(undone) + " of " + std::to_string(history->levels));
    const LatticeMesh level = meshOfHistory(*history, undone);
    const SolidReport now = checkSolid(level);
    ASSERT_EQ(now.faults(), "");
    ASSERT_EQ(topologyChange(now, original), "");
    for (const Triangle& t : level.boundary)
      for (const VertexId v : t)
        ASSERT_LE(testing::distanceOutside(solid.mesh, level.points[v]), tolerance + 1e-6);
  }
}

class RandomSolids : public ::testing::TestWithParam<std::uint32_t> {};

TEST_P(RandomSolids, keepEveryInvariantAtEveryLevel) { keepsItsPromises(GetParam(), inOnePiece); }

TEST_P(RandomSolids, keepEveryInvariantWithRoomOutside) {
  keepsItsPromisesOutside(GetParam(), inOnePiece);
}

TEST_P(RandomSolids, keepEveryInvariantInParts) {
  keepsItsPromises(GetParam(), inParts);
  keepsItsPromisesOutside(GetParam(), inParts);
}

TEST_P(RandomSolids, areTheSameForAnyNumberOfThreadsWhateverTheOptions) {
  const std::uint32_t seed = GetParam();
  const auto solid = randomSolid(seed);
  SCOPED_TRACE("seed " + std::to_string(seed) + ": " + solid.description);
  FusionOptions options;
  options.targetRatio = std::array{0.0, 0.1, 0.5}[seed % 3];
  options.envelopeTolerance = std::array{0.0, 0.01, 0.05, 0.3}[seed % 4];
  options.placement = std::array{PlacementRule::kAuto, PlacementRule::kOptimal,
                                 PlacementRule::kVertex}[seed / 2 % 3];
  const auto one = simplify(solid.mesh, options);
  ASSERT_TRUE(one) << one.error().text();
  for (const int threads : {2, 5}) {
    SCOPED_TRACE(std::to_string(threads) + " threads");
    options.threads = threads;
    const auto several = simplify(solid.mesh, options);
    ASSERT_TRUE(several) << several.error().text();
    testing::expectTheSame(*several, *one);
  }
  const auto parts = inParts(solid.mesh, options);
  options.threads = 1;
  const auto alone = inParts(solid.mesh, options);
  ASSERT_TRUE(parts && alone);
  testing::expectTheSame(*parts, *alone);
}

INSTANTIATE_TEST_SUITE_P(Seeds, RandomSolids, ::testing::Range(0u, kSeeds));

TEST(RandomSolids, asManyAsAreAskedFor) {
  const char* asked = std::getenv("QTET_RANDOM_SOLIDS");
  if (!asked)
    GTEST_SKIP() << "QTET_RANDOM_SOLIDS is not set; it says how many seeds to try beyond the first "
                 << kSeeds;
  const auto count = static_cast<std::uint32_t>(std::strtoul(asked, nullptr, 10));
  for (std::uint32_t seed = kSeeds; seed < kSeeds + count && !HasFailure(); ++seed)
    keepsItsPromises(seed, inOnePiece);
}

// The seeds are worth something only if they hold what makes simplifying hard.
TEST(RandomSolids, haveTunnelsCavitiesPartsAndPinches) {
  std::map<std::string, int> count;
  for (std::uint32_t seed = 0; seed < kSeeds; ++seed) {
    const SolidReport report = checkSolid(randomSolid(seed).mesh);
    count["several parts"] += report.betti[0] > 1;
    count["tunnels"] += report.betti[1] > 0;
    count["cavities"] += report.betti[2] > 0;
    count["singular vertices"] += !report.singularVertices.empty();
    count["singular edges"] += !report.singularEdges.empty();
    count["manifold"] += report.singularVertices.empty();
  }
  for (const auto& [what, seeds] : count) EXPECT_GE(seeds, 2) << what;
}

}  // namespace
}  // namespace qtet
