#include "simplify/fuse/fusion_proposer.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

namespace qtet {
namespace {

// A prey that costs more than this many times what its edge does is not worth looking at.
constexpr double kMaxLarger = 4;

// Counts the cells that go where an edge is not fused alone. These are the cells of its star that
// hold two prey vertices or more, and the cells beside it that hold the other two.
class CellsGoing {
 public:
  CellsGoing(const FusionMesh& mesh, const Star& edge)
      : mesh_(mesh), edge_(edge), alone_(edge.deleted.size()) {}
  [[nodiscard]] std::size_t with(VertexId v) const {
    return alone_ + static_cast<std::size_t>(std::ranges::count_if(
                        edge_.affected, [&](CellId c) { return mesh_.holds(c, v); }));
  }
  [[nodiscard]] std::size_t with(VertexId v, VertexId w) const {
    std::size_t one = 0, both = 0;
    for (const CellId c : edge_.affected) {
      const bool hasV = mesh_.holds(c, v), hasW = mesh_.holds(c, w);
      one += hasV || hasW, both += hasV && hasW;
    }
    // of the cells round v-w one is the prey
    assert(v != w && mesh_.cellsRound(v, w) > both);
    return alone_ + one + mesh_.cellsRound(v, w) - both - 1;
  }

 private:
  const FusionMesh& mesh_;
  const Star& edge_;
  std::size_t alone_;
};

}  // namespace

CellShares::CellShares() {
  shares_[0] = 1;
  for (std::size_t n = 1; n < shares_.size(); ++n) {
    const auto cells = static_cast<double>(n);
    shares_[n] = 1 / (cells * std::sqrt(cells));
  }
}

FusionProposer::FusionProposer(const FusionMesh& mesh, const FusionCost& cost,
                               const ChangeTimes& changes, const FusionLimits& limits,
                               const FusionPointOptions& options)
    : mesh_(mesh),
      cost_(cost),
      changes_(changes),
      test_(mesh, limits),
      finder_(mesh, cost, options) {}

void FusionProposer::candidatesOf(VertexId v, std::vector<Candidate>& found) {
  candidatesOf(v, {}, found);
}

void FusionProposer::candidatesOf(VertexId v, std::span<const VertexId> link,
                                  std::vector<Candidate>& found) {
  assert(mesh_.alive(v));
  found.clear();
  if (mesh_.star(v).size() > kMaxStarCells) return;
  mesh_.prefetchStar(v);
  for (const VertexId w : link)
    if (w != kGhost) cost_.prefetchSlot(w), mesh_.prefetchPoint(w);
  for (const CellId c : mesh_.star(v))
    for (const VertexId w : mesh_.cell(c))
      if (w < v && counts_.add(w) && link.empty()) cost_.prefetchSlot(w);
  assert(link.empty() || counts_.size() + 1 >= link.size());
  found.reserve(counts_.size());
  counts_.take([&](VertexId w, std::uint32_t cells) {
    assert(cells > 0 && mesh_.alive(w));
    if (mesh_.singular(w)) return;
    found.push_back({static_cast<float>(cells), w});
    cost_.prefetch(w);
  });
  price(v, found);
}

// The keys, which are the numbers of cells round the edges, become costs.
void FusionProposer::price(VertexId v, std::vector<Candidate>& found) const {
  const auto share = [this](const Candidate& c) {
    return shares_.of(static_cast<std::size_t>(c.key));
  };
  for (std::size_t i = 0; i < found.size(); i += 2) {
    Candidate &one = found[i], &other = found[std::min(i + 1, found.size() - 1)];
    const Pair keys =
        Pair{share(one), share(other)} * finder_.keysOf(v, {one.partner, other.partner});
    other.key = static_cast<float>(keys[1]), one.key = static_cast<float>(keys[0]);
  }
  std::sort(found.begin(), found.end());
}

bool FusionProposer::propose(VertexId owner, std::span<const Candidate> candidates, float most,
                             std::uint32_t now, Proposal& out) {
  assert(!candidates.empty());
  assert(candidates[0].partner < owner);
  assert(!changes_.isLocked(owner) && !changes_.isLocked(candidates[0].partner));
  assert(mesh_.alive(owner) && mesh_.alive(candidates[0].partner));
  assert(now == changes_.now());
  const Prey edge{2, {owner, candidates[0].partner, 0, 0}};
  const auto exact = test_.gatherBoundary(edge) ? finder_.price(edge, test_) : std::nullopt;
  const double share = shares_.of(mesh_.cellsRound(owner, candidates[0].partner));
  const auto price = static_cast<float>(share * exact.value_or(0));
  const bool isPriceAll = price > most;
  std::optional<FusionPoint> where;
  if (exact && !isPriceAll && !finder_.isHopeless(test_) && test_.gatherRest())
    where = finder_.choose(test_);
  if (!isPriceAll && (!where || !test_.keepsTopology())) {
    out.illegal.push_back({candidates[0].partner, price});
    return false;
  }
  out.partner = candidates[0].partner;
  out.madeAfter = now;
  out.price = price;
  out.isPriceAll = isPriceAll;
  if (isPriceAll) return true;
  out.prey = edge;
  out.where = *where;
  out.where.cost *= share;
  out.edgeCost = static_cast<float>(out.where.cost);
  out.most = most;
  assert(!test_.star().deleted.empty());
  test_.takeStar(out.star);
  takeAlong(candidates.subspan(1), most, out);
  out.tetrahedra = static_cast<std::uint32_t>(
      std::ranges::count_if(out.star.deleted, [this](CellId c) { return !mesh_.isGhost(c); }));
  return true;
}

// A fusion that costs more than `most` comes back, whatever it takes along.
void FusionProposer::takeAlong(std::span<const Candidate> others, float most, Proposal& out) {
  const double below = std::min(out.where.cost, static_cast<double>(most));
  findCompanions(out, others, below);
  const std::optional<Larger> larger = largerPrey(out, below);
  out.companions = companions_;
  if (!larger || !test_.gatherBoundary(larger->prey)) return;
  const auto price = finder_.price(larger->prey, test_);
  if (!price || larger->share * *price >= below || !test_.gatherRest()) return;
  const auto place = finder_.choose(test_);
  if (!place || larger->share * place->cost >= below || !test_.keepsTopology()) return;
  out.prey = larger->prey;
  out.where = *place;
  out.where.cost *= larger->share;
  test_.takeStar(out.star);
}

// Finds vertices round the edge that would not cost too much. A prey costs no less than any edge in
// it, and the costs of the owner's edges are known. The ones that are not free are among them at
// the end, since they may have been touched because of this edge's neighbours.
void FusionProposer::findCompanions(const Proposal& edge, std::span<const Candidate> others,
                                    double below) {
  companions_.clear();
  std::size_t free = 0;
  for (const Candidate& other : others) {
    if (other.key >= kMaxLarger * below) break;
    const auto holds = [&](CellId c) {
      return std::ranges::find(mesh_.cell(c), other.partner) != mesh_.cell(c).end();
    };
    if (!mesh_.alive(other.partner) || !std::ranges::any_of(edge.star.deleted, holds)) continue;
    companions_.push_back(other.partner);
    cost_.prefetch(other.partner);
    if (!changes_.isLocked(other.partner)) std::swap(companions_[free++], companions_.back());
  }
  assert(free <= companions_.size());
  freeCompanions_ = free;
}

// The cheapest triangle or tetrahedron round the edge, if its ideal cost is below that.
std::optional<FusionProposer::Larger> FusionProposer::largerPrey(const Proposal& edge,
                                                                 double below) const {
  std::optional<Larger> best;
  double cost = below;
  const auto consider = [&](const Prey& prey, std::size_t removed) {
    const double share = shares_.of(removed), c = share * finder_.ideal(prey).cost;
    if (c < cost) cost = c, best = {prey, share};
  };
  assert(edge.prey.k == 2 && freeCompanions_ <= companions_.size());
  const auto [a, b] = std::pair(edge.prey.vertex[0], edge.prey.vertex[1]);
  const auto free = std::span<const VertexId>(companions_).first(freeCompanions_);
  const CellsGoing going(mesh_, edge.star);
  for (const VertexId v : free) consider({3, {a, b, v, 0}}, going.with(v));
  for (const CellId c : edge.star.deleted) {
    std::array<VertexId, 2> taken{};
    std::size_t n = 0;
    for (const VertexId v : mesh_.cell(c))
      if (std::ranges::find(free, v) != free.end()) {
        assert(n < 2);  // the edge's vertices are not among them
        taken[n++] = v;
      }
    if (n == 2) consider({4, {a, b, taken[0], taken[1]}}, going.with(taken[0], taken[1]));
  }
  return best;
}

}  // namespace qtet
