#include "simplify/qtetfusion.h"

#include <algorithm>
#include <boost/heap/d_ary_heap.hpp>
#include <cmath>
#include <limits>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include "codec/small_order.h"
#include "proto/limits.h"
#include "simplify/fusion_mesh.h"
#include "simplify/fusion_test.h"

namespace qtet {
namespace {

// One fusion of a tetrahedron does what three to five of edges do; its quadric sums four vertices. Factors on the key, by k.
constexpr std::array<double, 5> kKeyFactor{0, 0, 1, 0.3, 0.1};
// A level ends where the next key passes this quantile of the keys at its start: about 5 % growth a level, as good as strict order.
constexpr double kLevelQuantile = 0.35;
// A pass over all candidates that removes less than this fraction of the cells is the last.
constexpr double kWorthAnotherPass = 0.002;
// How far (in radii of the prey) a quadric's minimum may lie from the prey's barycentre before it counts as ill-conditioned.
constexpr double kReach = 1.5;

// Keys are areas squared times a distance squared in lattice steps: scaled by a power of two, exactly, to what they would be at 16 bits, or
// the finest lattices would take them beyond a float.
constexpr int kLengthsInAKey = 6;
constexpr int kScaleBits = 16;

struct Candidate {
  float key = 0;
  std::array<VertexId, 3> partner{};  // the owner is the fourth
  std::uint8_t k = 2;
  bool operator<(const Candidate& other) const { return std::tie(key, k, partner) < std::tie(other.key, other.k, other.partner); }
};

struct Entry {
  double key = 0;
  VertexId owner = 0;
  // The heap keeps the largest on top; equal keys in order of the owner, so that the outcome is one and the same everywhere.
  bool operator<(const Entry& other) const { return key != other.key ? key > other.key : owner > other.owner; }
};

using Queue = boost::heap::d_ary_heap<Entry, boost::heap::arity<4>>;

class Simplifier {
 public:
  Simplifier(const LatticeMesh& mesh, const FusionOptions& options)
      : options_(options), mesh_(mesh), test_(mesh_), original_(mesh.tetrahedra.size()),
        target_(static_cast<std::size_t>(std::ceil(options.targetRatio * static_cast<double>(original_)))),
        keyScale_(std::ldexp(1.0, kLengthsInAKey * std::min(0, kScaleBits - mesh.lattice.bits))) {}

  Result<FusionHistory> run() {
    while (mesh_.liveTetrahedra() > target_) {
      const std::size_t before = mesh_.liveTetrahedra();
      fillQueue();
      while (!queue_.empty() && mesh_.liveTetrahedra() > target_ && level_ < kMaxLevels) runLevel();
      if (level_ == kMaxLevels && mesh_.liveTetrahedra() > target_)
        return fail(ErrorCode::kLimitExceeded, "4,096 levels do not reach the target; ask for more cells with --target-ratio");
      if (static_cast<double>(before - mesh_.liveTetrahedra()) < kWorthAnotherPass * static_cast<double>(before)) break;
    }
    return mesh_.takeHistory(level_);
  }

 private:
  struct List {
    std::size_t next = 0, end = 0;
  };

  void fillQueue() {
    candidates_.clear();
    lists_.assign(mesh_.vertexSlots(), {});
    locked_.resize(mesh_.vertexSlots(), 0);
    std::vector<Entry> entries;
    for (VertexId v = 0; v < mesh_.vertexSlots(); ++v)
      if (mesh_.alive(v) && !mesh_.singular(v)) {
        collect(v, true);
        if (lists_[v].next < lists_[v].end) entries.push_back({candidates_[lists_[v].next].key, v});
      }
    queue_.clear();
    queue_.reserve(entries.size());
    for (const Entry& e : entries) queue_.push(e);
    candidateLimit_ = candidates_.size() + candidates_.size() / 2 + 4096;
  }

  // Lists of dead owners and candidates with dead partners would outgrow the mesh several times.
  void compactCandidates() {
    std::vector<Candidate> kept;
    for (VertexId v = 0; v < mesh_.vertexSlots(); ++v) {
      const List old = lists_[v];
      lists_[v].next = kept.size();
      for (std::size_t i = old.next; mesh_.alive(v) && i < old.end; ++i)
        if (i == old.next || partnersAlive(candidates_[i])) kept.push_back(candidates_[i]);
      lists_[v].end = kept.size();
    }
    candidates_ = std::move(kept);
    candidateLimit_ = candidates_.size() + candidates_.size() / 2 + 4096;
  }

  [[nodiscard]] bool partnersAlive(const Candidate& c) const {
    return std::all_of(c.partner.begin(), c.partner.begin() + c.k - 1, [&](VertexId v) { return mesh_.alive(v); });
  }

  // All prey that hold v: its edges, and the triangles and tetrahedra of its star. `onlyLower` = v is their highest vertex.
  void collect(VertexId v, bool onlyLower) {
    List& list = lists_[v];
    list.next = candidates_.size();
    edges_.clear(), triangles_.clear();
    for (const CellId c : mesh_.star(v)) {
      std::array<VertexId, 3> w{};
      std::size_t n = 0;
      bool real = true;
      for (const VertexId x : mesh_.cell(c)) {
        if (x == v) continue;
        real &= x != kGhost;
        if (x != kGhost) w[n++] = x;
      }
      if (!real) continue;  // a boundary face belongs to a tetrahedron too
      std::ranges::sort(w);
      for (std::size_t i = 0; i < 3; ++i) edges_.push_back(w[i]), triangles_.push_back({w[i == 0], w[i == 2 ? 1 : 2]});
      offer({v, w[0], w[1], w[2]}, 4, onlyLower);
    }
    std::ranges::sort(edges_);
    std::ranges::sort(triangles_);
    edges_.erase(std::ranges::unique(edges_).begin(), edges_.end());
    triangles_.erase(std::ranges::unique(triangles_).begin(), triangles_.end());
    for (const auto& t : triangles_) offer({v, t[0], t[1], 0}, 3, onlyLower);
    for (const VertexId w : edges_) offer({v, w, 0, 0}, 2, onlyLower);
    std::sort(candidates_.begin() + static_cast<std::ptrdiff_t>(list.next), candidates_.end());
    list.end = candidates_.size();
  }

  void offer(const std::array<VertexId, 4>& vertices, std::uint8_t k, bool onlyLower) {
    for (std::size_t i = 1; i < k; ++i)
      if (mesh_.singular(vertices[i]) || (onlyLower && vertices[i] > vertices[0])) return;
    const Prey prey{k, vertices};
    const auto key = static_cast<float>(keyScale_ * kKeyFactor[k] * quadricOf(prey).at(ideal(prey)));
    candidates_.push_back({key, {vertices[1], vertices[2], vertices[3]}, k});
  }

  [[nodiscard]] Quadric quadricOf(const Prey& prey) const {
    Quadric q;
    for (const VertexId v : prey.vertices()) q += mesh_.quadric(v);
    return q;
  }

  // Eq. 6-7 where that is well-conditioned, else the barycentre; of a prey with one boundary vertex, that vertex.
  [[nodiscard]] Vector3 ideal(const Prey& prey) const {
    std::size_t boundary = 0;
    Vector3 centre{};
    for (const VertexId v : prey.vertices()) boundary += mesh_.onBoundary(v);
    for (const VertexId v : prey.vertices())
      if (boundary == 0 || mesh_.onBoundary(v)) centre = centre + (1.0 / static_cast<double>(boundary ? boundary : prey.k)) * mesh_.position(v);
    if (boundary == 1) return centre;
    const auto minimum = quadricOf(prey).minimum();
    if (!minimum) return centre;
    double radius = 0;
    for (const VertexId v : prey.vertices()) radius = std::max(radius, dot(mesh_.position(v) - centre, mesh_.position(v) - centre));
    const Vector3 off = *minimum - centre;
    return dot(off, off) <= kReach * kReach * radius ? *minimum : centre;
  }

  void runLevel() {
    const double limit = keyLimit();
    const std::size_t fusions = fusions_;
    deferred_.clear();
    ++level_;
    while (!queue_.empty() && mesh_.liveTetrahedra() > target_) {
      const Entry top = queue_.top();
      if (top.key > limit && fusions_ > fusions) break;
      queue_.pop();
      if (mesh_.alive(top.owner)) process(top.owner);
    }
    for (const Entry& e : deferred_) queue_.push(e);
    if (fusions_ == fusions) --level_;  // nothing was legal: no such level
    if (candidates_.size() > candidateLimit_) compactCandidates();
    if (options_.progress) options_.progress(progress());
  }

  [[nodiscard]] double keyLimit() {
    keys_.clear();
    for (const Entry& e : queue_) keys_.push_back(e.key);
    const auto at = keys_.begin() + static_cast<std::ptrdiff_t>(kLevelQuantile * static_cast<double>(keys_.size()));
    if (at == keys_.end()) return std::numeric_limits<double>::infinity();
    std::nth_element(keys_.begin(), at, keys_.end());
    return *at;
  }

  void process(VertexId owner) {
    List& list = lists_[owner];
    const Candidate candidate = candidates_[list.next];
    Prey prey{candidate.k, {owner, candidate.partner[0], candidate.partner[1], candidate.partner[2]}};
    const bool gone = !partnersAlive(candidate);
    if (!gone && std::ranges::any_of(prey.vertices(), [&](VertexId v) { return locked_[v] == level_; })) {
      deferred_.push_back({candidate.key, owner});
      return;
    }
    if (!gone && tryFuse(prey)) return;
    while (++list.next < list.end && !partnersAlive(candidates_[list.next])) {
    }
    if (list.next < list.end) queue_.push({candidates_[list.next].key, owner});
  }

  bool tryFuse(const Prey& prey) {
    FusionPoint where;
    if (!test_.gather(prey) || !place(prey, where) || !test_.keepsTopology()) return false;
    const VertexId fused = mesh_.fuse(prey, where, test_.affected(), test_.labels(), test_.deleted(), test_.linkVertices(), level_ - 1);
    locked_.resize(mesh_.vertexSlots(), 0);
    lists_.resize(mesh_.vertexSlots());
    locked_[fused] = level_;
    for (const VertexId v : test_.linkVertices())
      if (v != kGhost) locked_[v] = level_;
    ++fusions_;
    collect(fused, false);
    if (lists_[fused].next < lists_[fused].end) deferred_.push_back({candidates_[lists_[fused].next].key, fused});
    return true;
  }

  // The fusion point: the quadric's minimum, moved inside the envelope where need be, else the prey vertex of least error that fits.
  bool place(const Prey& prey, FusionPoint& where) const {
    std::size_t boundary = 0;
    for (const VertexId v : prey.vertices()) boundary += mesh_.onBoundary(v);
    where.stays = FusionPoint::kMoves;
    if (boundary != 1 && test_.projectInside(ideal(prey), where.point) && test_.keepsCells(where.point)) {
      for (int i = 0; i < prey.k; ++i)
        if (mesh_.point(prey.vertex[static_cast<std::size_t>(i)]) == where.point) where.stays = i;
      return true;
    }
    const Quadric q = quadricOf(prey);
    std::array<double, 4> error{};
    for (std::size_t i = 0; i < prey.k; ++i) error[i] = q.at(mesh_.position(prey.vertex[i]));
    const auto order = smallOrder(prey.k, [&](std::size_t a, std::size_t b) { return error[a] < error[b]; });
    for (const std::size_t i : std::span(order).first(prey.k)) {
      if (boundary > 0 && !mesh_.onBoundary(prey.vertex[i])) continue;
      where = {mesh_.point(prey.vertex[i]), static_cast<int>(i)};
      if (test_.insideEnvelope(where.point) && test_.keepsCells(where.point)) return true;
    }
    return false;
  }

  [[nodiscard]] double progress() const {
    const double all = static_cast<double>(original_ - target_);
    // Removal is geometric, so is the bar: the logarithm of what is left.
    if (all <= 0 || target_ == 0) return 1;
    return std::log(static_cast<double>(original_) / static_cast<double>(std::max(mesh_.liveTetrahedra(), target_))) /
           std::log(static_cast<double>(original_) / static_cast<double>(target_));
  }

  const FusionOptions& options_;
  FusionMesh mesh_;
  FusionTest test_;
  std::size_t original_, target_;
  double keyScale_;
  std::uint32_t level_ = 0;
  std::size_t fusions_ = 0;
  Queue queue_;
  std::vector<Candidate> candidates_;
  std::size_t candidateLimit_ = 0;
  std::vector<List> lists_;
  std::vector<std::uint32_t> locked_;  // by vertex: the level that locked it last
  std::vector<Entry> deferred_;
  std::vector<double> keys_;
  std::vector<VertexId> edges_;
  std::vector<std::array<VertexId, 2>> triangles_;
};

}  // namespace

Result<FusionHistory> simplify(const LatticeMesh& mesh, const FusionOptions& options) {
  if (mesh.tetrahedra.empty()) return fail(ErrorCode::kBadInput, "the mesh has no tetrahedra");
  if (!(options.targetRatio >= 0 && options.targetRatio <= 1)) return fail(ErrorCode::kBadInput, "the target ratio must lie in 0..1");
  return Simplifier(mesh, options).run();
}

}  // namespace qtet
