#include "simplify/fusion_proposer.h"

#include <algorithm>
#include <array>

namespace qtet {
namespace {

// Factors on the cost, by k: a triangle's fusion does what two or three of edges do, a tetrahedron's what three to six do, and their quadrics
// sum more vertices.
constexpr std::array<double, 5> kCostFactor{0, 0, 1, 0.5, 0.25};

}  // namespace

void FusionProposer::candidatesOf(VertexId v, bool onlyLower, std::vector<Candidate>& found) {
  neighbours_.clear();
  found.clear();
  mesh_.prefetchStar(v);
  for (const CellId c : mesh_.star(v))
    for (const VertexId w : mesh_.cell(c)) {
      if (w == v || w == kGhost || (onlyLower && w > v) || neighbours_.intern(w) < found.size()) continue;
      found.push_back({0, w});
      cost_.prefetch(w);
    }
  std::erase_if(found, [&](const Candidate& c) { return mesh_.singular(c.partner); });
  for (Candidate& c : found) c.key = static_cast<float>(finder_.ideal({2, {v, c.partner, 0, 0}}).cost);
  std::sort(found.begin(), found.end());
}

void FusionProposer::propose(VertexId owner, VertexId partner, std::uint32_t levelStart, std::uint32_t now, Proposal& out) {
  const Prey edge{2, {owner, partner, 0, 0}};
  out.owner = owner;
  out.partner = partner;
  out.legal = false;
  out.madeAfter = now;
  out.ring.clear();
  if (!test_.gather(edge)) return;
  const auto where = finder_.find(edge, test_);
  if (!where || !test_.keepsTopology()) return;
  out.legal = true;
  out.prey = edge;
  out.where = *where;
  out.star = test_.star();
  ringOf(edge, out.ring);
  const Prey larger = largerPrey(edge, out.ring, where->cost, levelStart);
  if (larger.k == 2 || !test_.gather(larger)) return;
  const auto place = finder_.find(larger, test_);
  const double factor = kCostFactor[larger.k];
  if (!place || factor * place->cost >= where->cost || !test_.keepsTopology()) return;
  out.prey = larger;
  out.where = *place;
  out.where.cost *= factor;
  out.star = test_.star();
}

void FusionProposer::ringOf(const Prey& edge, std::vector<VertexId>& ring) const {
  for (const CellId c : test_.star().deleted)
    for (const VertexId v : mesh_.cell(c))
      if (v != edge.vertex[0] && v != edge.vertex[1] && v != kGhost && std::ranges::find(ring, v) == ring.end()) ring.push_back(v);
}

// The cheapest triangle or tetrahedron round the edge, if cheaper than the edge; its ideal cost decides.
Prey FusionProposer::largerPrey(const Prey& edge, std::span<const VertexId> ring, double cost, std::uint32_t levelStart) const {
  Prey best = edge;
  const auto consider = [&](const Prey& prey) {
    const double c = kCostFactor[prey.k] * finder_.ideal(prey).cost;
    if (c < cost) cost = c, best = prey;
  };
  const auto free = [&](VertexId v) { return v != kGhost && !mesh_.singular(v) && !touched_.since(v, levelStart); };
  for (const VertexId v : ring)
    if (free(v)) consider({3, {edge.vertex[0], edge.vertex[1], v, 0}});
  for (const CellId c : test_.star().deleted) {
    std::array<VertexId, 2> others{};
    std::size_t n = 0;
    for (const VertexId v : mesh_.cell(c))
      if (v != edge.vertex[0] && v != edge.vertex[1]) others[n++] = v;
    if (free(others[0]) && free(others[1])) consider({4, {edge.vertex[0], edge.vertex[1], others[0], others[1]}});
  }
  return best;
}

}  // namespace qtet
