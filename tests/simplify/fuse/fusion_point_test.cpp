// The points that a placement rule allows, their record in the history, and the rules' costs beside
// each other.
#include "simplify/fuse/fusion_point.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "simplify/fuse/qtetfusion.h"
#include "tests/support/meshes.h"

namespace qtet {
namespace {

using testing::gridMesh;

FusionHistory historyBy(PlacementRule rule) {
  FusionOptions options;
  options.placement = rule;
  options.targetRatio = 0.02;
  options.envelopeTolerance = 0;
  return simplify(gridMesh(5, 1), options).value();
}

std::array<std::size_t, 4> placements(const FusionHistory& history) {
  std::array<std::size_t, 4> count{};
  for (const Fusion& f : history.fusions) ++count[static_cast<std::size_t>(f.placement)];
  return count;
}

TEST(FusionPoint, theVertexRuleKeepsOriginalVerticesAlone) {
  const FusionHistory history = historyBy(PlacementRule::kVertex);
  ASSERT_FALSE(history.fusions.empty());
  EXPECT_EQ(placements(history)[static_cast<std::size_t>(Placement::kAtPrey)],
            history.fusions.size());
  for (const Fusion& f : history.fusions)
    ASSERT_EQ(history.points[f.fused], history.points[f.prey[0]]);
}

TEST(FusionPoint, theAutomaticRuleMostlyFollowsFromThePreyTheOptimalOneSeldom) {
  const auto automatic = placements(historyBy(PlacementRule::kAuto)),
             optimal = placements(historyBy(PlacementRule::kOptimal));
  const auto freeShare = [](const std::array<std::size_t, 4>& count) {
    return static_cast<double>(count[3]) /
           static_cast<double>(count[0] + count[1] + count[2] + count[3]);
  };
  EXPECT_LT(freeShare(automatic), 0.5);
  EXPECT_GT(freeShare(optimal), freeShare(automatic));
  for (const std::size_t count : automatic) EXPECT_GT(count, 0u);
}

TEST(FusionPoint, theHistorySaysWhereTheFusedVertexLies) {
  for (const PlacementRule rule : {PlacementRule::kAuto, PlacementRule::kOptimal}) {
    const FusionHistory history = historyBy(rule);
    for (const Fusion& f : history.fusions) {
      std::array<LatticePoint, 4> prey{};
      for (std::size_t i = 0; i < f.k; ++i) prey[i] = history.points[f.prey[i]];
      const LatticePoint& fused = history.points[f.fused];
      const std::span<const LatticePoint> all(prey.data(), f.k);
      const bool atPrey = std::ranges::find(all, fused) != all.end();
      const bool atQuarter =
          f.k == 2 && (fused == quarter(prey[0], prey[1]) || fused == quarter(prey[1], prey[0]));
      switch (f.placement) {
        case Placement::kAtPrey: ASSERT_EQ(fused, prey[0]); break;
        case Placement::kMiddle: ASSERT_EQ(fused, middle(all)); break;
        case Placement::kQuarter: ASSERT_EQ(fused, quarter(prey[0], prey[1])); break;
        case Placement::kFree:
          ASSERT_FALSE(atPrey || atQuarter || fused == middle(all))
              << "a free point takes bits that this one need not";
          break;
      }
    }
  }
}

/// Calls `use` with each edge that a test gathers, once a cell.
template <class Use>
void forEachEdge(const LatticeMesh& mesh, FusionCheck& test, const Use& use) {
  for (const Tetrahedron& t : mesh.tetrahedra)
    for (std::size_t i = 1; i < 4; ++i)
      if (const Prey prey{2, {t[i], t[0], 0, 0}}; test.gather(prey)) use(prey);
}

TEST(FusionPoint, theAutomaticRulePaysForBitsWithAtMostFourTimesTheCost) {
  const LatticeMesh mesh = gridMesh(4, 2);
  const FusionMesh live(mesh);
  const FusionCost cost(live, mesh, {});
  FusionCheck test(live);
  FusionPointFinder automatic(live, cost, {PlacementRule::kAuto}),
      optimal(live, cost, {PlacementRule::kOptimal}), vertex(live, cost, {PlacementRule::kVertex});
  std::size_t found = 0, dearer = 0;
  forEachEdge(mesh, test, [&](const Prey& prey) {
    const auto any = automatic.find(prey, test), best = optimal.find(prey, test),
               original = vertex.find(prey, test);
    if (best) {
      ASSERT_TRUE(any) << "looks at all that the optimal rule looks at";
      EXPECT_LE(any->cost, 4 * best->cost * (1 + 1e-12));
      ++found;
      dearer += any->cost > best->cost;
    }
    if (original) {
      ASSERT_TRUE(any);
      EXPECT_LE(any->cost, original->cost * (1 + 1e-12));
      const bool isPrey = original->point == mesh.points[prey.vertex[0]] ||
                          original->point == mesh.points[prey.vertex[1]];
      EXPECT_TRUE(isPrey);
    }
  });
  EXPECT_GT(found, 100u);
  EXPECT_GT(dearer, 0u);
}

TEST(FusionPoint, thePriceIsKnownFromTheBoundaryAlone) {
  const LatticeMesh mesh = gridMesh(4, 2);
  const FusionMesh live(mesh);
  const FusionCost cost(live, mesh, {});
  FusionCheck test(live), whole(live);
  FusionPointFinder pricing(live, cost, {PlacementRule::kOptimal}),
      finder(live, cost, {PlacementRule::kOptimal});
  std::size_t same = 0, dearer = 0;
  forEachEdge(mesh, whole, [&](const Prey& prey) {
    ASSERT_TRUE(test.gatherBoundary(prey));
    const auto price = pricing.price(prey, test);
    const auto found = finder.find(prey, whole);
    if (!found) return;
    ASSERT_TRUE(price);
    ASSERT_LE(*price, found->cost);
    ++(*price == found->cost ? same : dearer);
  });
  EXPECT_GT(same, 50u);
  EXPECT_GT(dearer, 0u) << "some points flip cells, some shapes cost";
}

TEST(FusionPoint, theKeysOfTwoEdgesAreThoseOfEachAlone) {
  const LatticeMesh mesh = gridMesh(4, 2);
  const FusionMesh live(mesh);
  const FusionCost cost(live, mesh, {});
  for (const PlacementRule rule :
       {PlacementRule::kAuto, PlacementRule::kOptimal, PlacementRule::kVertex}) {
    const FusionPointFinder finder(live, cost, {rule});
    for (const Tetrahedron& t : mesh.tetrahedra) {
      const Pair both = finder.keysOf(t[0], {t[1], t[2]}),
                 first = finder.keysOf(t[0], {t[1], t[1]}),
                 second = finder.keysOf(t[0], {t[2], t[2]});
      ASSERT_EQ(both[0], first[0]);
      ASSERT_EQ(first[0], first[1]);
      ASSERT_EQ(both[1], second[1]);
    }
  }
}

TEST(FusionPoint, theKeyOfAnInnerEdgeIsWhatItsPointsCost) {
  const LatticeMesh mesh = gridMesh(4, 2);
  const FusionMesh live(mesh);
  const FusionCost cost(live, mesh, {});
  FusionCheck test(live);
  for (const PlacementRule rule : {PlacementRule::kAuto, PlacementRule::kVertex}) {
    FusionPointFinder finder(live, cost, {rule});
    std::size_t asked = 0, cheap = 0;
    forEachEdge(mesh, test, [&](const Prey& prey) {
      if (live.onBoundary(prey.vertex[0]) || live.onBoundary(prey.vertex[1])) return;
      const double key = finder.keysOf(prey.vertex[0], {prey.vertex[1], prey.vertex[1]})[0],
                   ideal = finder.ideal(prey).cost;
      const double price = finder.price(prey, test).value();
      ++asked;
      ASSERT_GE(key, ideal * (1 - 1e-9));
      // a free point, which need not lie on the lattice
      if (rule == PlacementRule::kAuto && key <= ideal * (1 + 1e-9)) return;
      ++cheap;
      ASSERT_NEAR(key, price, 0.05 * price)
          << "middle and quarters fall on the lattice a little beside the edge";
    });
    EXPECT_GT(asked, 10u);
    EXPECT_GT(cheap, 5u);
  }
}

TEST(FusionPoint, anInnerVertexIsHopelessOnlyWhereNoPointOfTheBoundaryIsLegal) {
  const LatticeMesh mesh = gridMesh(4, 2);
  const FusionMesh live(mesh);
  const FusionCost cost(live, mesh, {});
  FusionCheck test(live);
  for (const PlacementRule rule :
       {PlacementRule::kAuto, PlacementRule::kOptimal, PlacementRule::kVertex}) {
    FusionPointFinder asked(live, cost, {rule}), finder(live, cost, {rule});
    std::size_t hopeless = 0, found = 0;
    forEachEdge(mesh, test, [&](const Prey& prey) {
      const auto place = finder.find(prey, test);
      if (!asked.price(prey, test)) return;
      const bool isHopeless = asked.isHopeless(test);
      const bool isWrong = isHopeless && place.has_value();
      ASSERT_FALSE(isWrong) << "there is a point";
      if (live.onBoundary(prey.vertex[0]) == live.onBoundary(prey.vertex[1])) {
        ASSERT_FALSE(isHopeless) << "is not asked";
      }
      if (place) {
        ASSERT_EQ(asked.choose(test)->point, place->point) << "asking changes nothing";
      }
      hopeless += isHopeless, found += place.has_value();
    });
    EXPECT_GT(hopeless, 10u);
    EXPECT_GT(found, 50u);
  }
}

TEST(FusionPoint, whatItFindsIsLegal) {
  const LatticeMesh mesh = gridMesh(4, 3);
  const FusionMesh live(mesh);
  const FusionCost cost(live, mesh, {});
  FusionCheck test(live);
  for (const PlacementRule rule :
       {PlacementRule::kAuto, PlacementRule::kOptimal, PlacementRule::kVertex}) {
    FusionPointFinder finder(live, cost, {rule});
    std::size_t found = 0;
    forEachEdge(mesh, test, [&](const Prey& prey) {
      const auto point = finder.find(prey, test);
      if (!point) return;
      ++found;
      EXPECT_GE(test.shapeAt(point->point), 0);
      EXPECT_TRUE(test.insideEnvelope(point->point));
    });
    EXPECT_GT(found, 50u);
  }
}

}  // namespace
}  // namespace qtet
