// The measure that compares candidates and proposals: the error that a fusion adds, by the
// tetrahedra and boundary triangles that it removes.
#include "simplify/fuse/fusion_proposer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "codec/mesh/boundary.h"
#include "tests/support/meshes.h"

namespace qtet {
namespace {

double share(std::size_t cells) {
  return 1 / (static_cast<double>(cells) * std::sqrt(static_cast<double>(cells)));
}

class Proposed : public ::testing::Test {
 protected:
  FusionProposer proposer() const { return {mesh_, cost_, changes_, {}, kOptions}; }
  /// Tetrahedra and boundary triangles.
  std::size_t cellsRound(VertexId v, VertexId w) const {
    const auto holdsBoth = [&](const auto& cell) {
      return std::ranges::count(cell, v) + std::ranges::count(cell, w) == 2;
    };
    return static_cast<std::size_t>(std::ranges::count_if(lattice_.tetrahedra, holdsBoth) +
                                    std::ranges::count_if(boundary_, holdsBoth));
  }

  static constexpr FusionPointOptions kOptions{PlacementRule::kOptimal};
  LatticeMesh lattice_ = testing::gridMesh(6, 1);
  std::vector<Triangle> boundary_ = boundaryOf(lattice_.tetrahedra);
  FusionMesh mesh_{lattice_};
  FusionCost cost_{mesh_, lattice_, {}};
  ChangeTimes changes_;

  Proposed() { changes_.resize(mesh_.vertexSlots()); }
};

TEST_F(Proposed, keysAreWhatTheEdgeCostsByTheCellsRoundIt) {
  FusionProposer proposer = this->proposer();
  const FusionPointFinder finder(mesh_, cost_, kOptions);
  std::vector<Candidate> found, again;
  for (VertexId v = 0; v < mesh_.vertexSlots(); ++v) {
    proposer.candidatesOf(v, found);
    for (const Candidate& c : found) {
      const double cost = finder.keysOf(v, {c.partner, c.partner})[0];
      ASSERT_FLOAT_EQ(c.key, static_cast<float>(share(cellsRound(v, c.partner)) * cost));
    }
  }
  // The highest vertex is above all of its neighbours, so that its link may be handed over.
  const auto top = static_cast<VertexId>(mesh_.vertexSlots() - 1);
  proposer.candidatesOf(top, found);
  std::vector<VertexId> link;
  for (const Candidate& c : found) link.push_back(c.partner);
  link.push_back(kGhost);
  proposer.candidatesOf(top, link, again);
  ASSERT_EQ(again.size(), found.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_EQ(again[i].key, found[i].key);
    EXPECT_EQ(again[i].partner, found[i].partner);
  }
}

TEST_F(Proposed, proposalsCostWhatTheyAddByTheCellsThatGo) {
  FusionProposer proposer = this->proposer();
  FusionPointFinder finder(mesh_, cost_, kOptions);
  FusionCheck test(mesh_, {});
  std::vector<Candidate> found;
  std::array<std::size_t, 5> seen{};
  for (VertexId v = 0; v < mesh_.vertexSlots(); ++v) {
    proposer.candidatesOf(v, found);
    Proposal proposal;
    if (found.empty() ||
        !proposer.propose(v, found, std::numeric_limits<float>::infinity(), 0, proposal))
      continue;
    ASSERT_TRUE(test.gather(proposal.prey));
    const auto place = finder.find(proposal.prey, test);
    ASSERT_TRUE(place);
    EXPECT_EQ(place->point, proposal.where.point);
    EXPECT_DOUBLE_EQ(proposal.where.cost, place->cost * share(proposal.star.deleted.size()));
    ++seen[proposal.prey.k];
  }
  for (const std::size_t k : {2, 3, 4}) EXPECT_GT(seen[k], 0u) << "no prey of " << k;
}

TEST_F(Proposed, whatAVertexIsOffByAlreadyIsNoFusionsCost) {
  FusionProposer proposer = this->proposer();
  const FusionPointFinder finder(mesh_, cost_, kOptions);
  std::vector<Candidate> found;
  VertexId v = 0;
  for (; v < mesh_.vertexSlots(); ++v) {
    EXPECT_EQ(cost_.of(v), 0) << "in the input nothing is off";
    Proposal proposal;
    proposer.candidatesOf(v, found);
    if (found.empty() ||
        !proposer.propose(v, found, std::numeric_limits<float>::infinity(), 0, proposal))
      continue;
    std::vector<double> values(cost_.components());
    const double cost = cost_.valuesAt(proposal.prey, proposal.where.point, values);
    if (!(cost > 0)) continue;
    std::size_t components = 0;  // of point fields
    for (const FieldInfo& field : lattice_.fields)
      if (!isCellField(field)) components += field.components;
    const std::vector<std::int32_t> integers(components);
    const VertexId fused =
        mesh_.fuse(proposal.prey, {proposal.where.point, integers}, proposal.star, 0);
    cost_.makeRoom(mesh_.vertexSlots());
    cost_.fuse(proposal.prey, fused, proposal.where.point, values);
    EXPECT_NEAR(cost_.of(fused), cost, 1e-9 * cost);
    const VertexId w =
        *std::ranges::find_if(proposal.star.link, [](VertexId u) { return u != kGhost; });
    const Prey edge{2, {fused, w, 0, 0}};
    const FusionPointFinder::Ideal ideal = finder.ideal(edge);
    EXPECT_NEAR(ideal.cost, std::max(0.0, cost_.of(edge).quadric.at(ideal.offset) - cost),
                1e-9 * cost);
    return;
  }
  FAIL() << "no fusion costs anything";
}

}  // namespace
}  // namespace qtet
