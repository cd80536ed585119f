#include "simplify/fusion_proposer.h"

#include <algorithm>
#include <array>

namespace qtet {
namespace {

// Factors on the cost, by k: a triangle's fusion does what two or three of edges do, a tetrahedron's what three to six do, and their quadrics
// sum more vertices. Where bytes count, larger prey count for more: 6 % fewer records for 2 % of error.
constexpr std::array<double, 5> kLeastError{0, 0, 1, 0.5, 0.25}, kLeastBytes{0, 0, 1, 0.4, 0.15};

}  // namespace

FusionProposer::FusionProposer(const FusionMesh& mesh, const FusionCost& cost, const Touched& touched, const BandNodes& band,
                               const FusionLimits& limits, const FusionPointOptions& options)
    : mesh_(mesh),
      cost_(cost),
      touched_(touched),
      band_(band),
      costFactor_(options.rule == PlacementRule::kOptimal ? kLeastError : kLeastBytes),
      test_(mesh, limits),
      finder_(mesh, cost, options) {}

void FusionProposer::candidatesOf(VertexId v, bool onlyLower, std::vector<Candidate>& found) {
  neighbours_.clear();
  found.clear();
  if (mesh_.star(v).size() > kMostStarCells) return;
  mesh_.prefetchStar(v);
  for (const CellId c : mesh_.star(v))
    for (const VertexId w : mesh_.cell(c))
      if (w != kGhost) cost_.prefetchSlot(w);
  for (const CellId c : mesh_.star(v))
    for (const VertexId w : mesh_.cell(c)) {
      if (w == v || w == kGhost || (onlyLower && w > v) || !band_.allows(v, w) || neighbours_.intern(w) < found.size()) continue;
      found.push_back({0, w});
      cost_.prefetch(w);
    }
  std::erase_if(found, [&](const Candidate& c) { return mesh_.singular(c.partner); });
  for (Candidate& c : found) c.key = static_cast<float>(finder_.ideal({2, {v, c.partner, 0, 0}}).cost);
  std::sort(found.begin(), found.end());
}

bool FusionProposer::propose(VertexId owner, std::span<const Candidate> candidates, std::uint32_t levelStart, std::uint32_t now,
                             Proposal& out) {
  const Prey edge{2, {owner, candidates[0].partner, 0, 0}};
  const auto where = test_.gather(edge) ? finder_.find(edge, test_) : std::nullopt;
  if (!where || !test_.keepsTopology()) {
    out.illegal.push_back(candidates[0].partner);
    return false;
  }
  out.partner = candidates[0].partner;
  out.madeAfter = now;
  out.prey = edge;
  out.where = *where;
  out.star = test_.star();
  takeAlong(candidates.subspan(1), levelStart, out);
  return true;
}

void FusionProposer::takeAlong(std::span<const Candidate> others, std::uint32_t levelStart, Proposal& out) {
  const Prey larger = largerPrey(out.prey, others, out.where.cost, levelStart);
  out.companions = companions_;
  if (larger.k == 2 || !test_.gather(larger)) return;
  const auto place = finder_.find(larger, test_);
  const double factor = costFactor_[larger.k];
  if (!place || factor * place->cost >= out.where.cost || !test_.keepsTopology()) return;
  out.prey = larger;
  out.where = *place;
  out.where.cost *= factor;
  out.star = test_.star();
}

// Vertices round the edge that would not cost too much: a prey costs no less than any edge in it, and those of the owner are known. The ones that are
// not free are among them at the end, since they may have been touched because of this edge's neighbours.
void FusionProposer::findCompanions(std::span<const Candidate> others, double cost, std::uint32_t levelStart) {
  companions_.clear();
  std::size_t free = 0;
  for (const Candidate& other : others) {
    if (costFactor_[4] * other.key >= cost) break;
    const auto holds = [&](CellId c) { return std::ranges::find(mesh_.cell(c), other.partner) != mesh_.cell(c).end(); };
    if (!mesh_.alive(other.partner) || !std::ranges::any_of(test_.star().deleted, holds)) continue;
    companions_.push_back(other.partner);
    if (!touched_.since(other.partner, levelStart)) std::swap(companions_[free++], companions_.back());
  }
  freeCompanions_ = free;
}

// The cheapest triangle or tetrahedron round the edge, if cheaper than the edge; its ideal cost decides.
Prey FusionProposer::largerPrey(const Prey& edge, std::span<const Candidate> others, double cost, std::uint32_t levelStart) {
  findCompanions(others, cost, levelStart);
  Prey best = edge;
  const auto consider = [&](const Prey& prey) {
    const double c = costFactor_[prey.k] * finder_.ideal(prey).cost;
    if (c < cost) cost = c, best = prey;
  };
  const auto [a, b] = std::pair(edge.vertex[0], edge.vertex[1]);
  const auto free = std::span(companions_).first(freeCompanions_);
  for (const VertexId v : free) consider({3, {a, b, v, 0}});
  for (const CellId c : test_.star().deleted) {
    std::array<VertexId, 2> taken{};
    std::size_t n = 0;
    for (const VertexId v : mesh_.cell(c))
      if (std::ranges::find(free, v) != free.end()) taken[n++] = v;
    if (n == 2) consider({4, {a, b, taken[0], taken[1]}});
  }
  return best;
}

}  // namespace qtet
