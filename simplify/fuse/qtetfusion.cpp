#include "simplify/fuse/qtetfusion.h"

#include <algorithm>
#include <array>
#include <boost/heap/d_ary_heap.hpp>
#include <cassert>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "proto/limits.h"
#include "simplify/fuse/band_nodes.h"
#include "simplify/fuse/candidates.h"
#include "simplify/fuse/fusion_mesh.h"
#include "simplify/fuse/fusion_proposer.h"
#include "simplify/fuse/level_proposals.h"
#include "simplify/fuse/queue_entries.h"
#include "simplify/mesh/stopping.h"
#include "simplify/mesh/tet_mesh.h"
#include "simplify/mesh/workers.h"

namespace qtet {
namespace {

// A level ends where the next key passes this quantile of the keys at its start: about 5 % growth a
// level, as good as strict order.
constexpr double kLevelQuantile = 0.35;
// A pass over all candidates that removes less than this fraction of the cells is the last.
constexpr double kWorthAnotherPass = 0.002;
// A level of a band that removes less than this fraction of the cells is its last: what is left is
// dear, and waits for larger nodes.
constexpr double kWorthAnotherLevel = 0.015;
// No new cell may be shaped worse than this, or than a fifth of its star's worst (1 = regular, 0 =
// flat).
constexpr double kShapeFloor = 1e-4;
// Cosine of the largest angle by which a boundary triangle may turn in one fusion: more, and a fold
// could hide what the quadric does not see.
constexpr double kNormalCosine = 0.3;

// Vertices whose candidates are found at once, and how many of them a thread takes at a time.
constexpr std::size_t kCollected = 4096;
constexpr std::size_t kGrain = 8;
// Vertices of the queue that a thread takes at a time.
constexpr std::size_t kFilled = 1024;
// How many fused vertices ahead the memory is asked for what their candidates are found from.
constexpr std::size_t kFusedAhead = 2;
// The same of vertices for the queue.
constexpr std::size_t kListsAhead = 8;
// Candidates a vertex, most of the time: 7 in a large mesh, and gaps of as many.
constexpr std::size_t kMaxCandidates = 16;

using Queue = boost::heap::d_ary_heap<QueueEntry, boost::heap::arity<4>>;

/// Null where the fusion is not legal; that, too, is known only of what costs no more than it may.
struct Outcome {
  const Proposal* proposal;
  float cost;
};

/// Of a run of vertices: where what is left of it ends.
struct Filled {
  std::size_t vertices = 0, entries = 0;
};

class Simplifier {
 public:
  Simplifier(const LatticeMesh& mesh, const FusionOptions& options)
      : options_(options),
        workers_(options.threads, options.stop),
        mesh_(mesh, options.regionField.value_or(FusionMesh::kNoRegions), &workers_),
        cost_(mesh_, mesh, options.cost, &workers_),
        band_(options.bands.cellsPerPacket == 0
                  ? BandNodes()
                  : BandNodes(mesh_, mesh, options.bands.cellsPerPacket)),
        original_(mesh.tetrahedra.size()),
        target_(static_cast<std::size_t>(options.targetRatio * static_cast<double>(original_))) {
    for (const FieldInfo& field : mesh_.fields())
      if (!isCellField(field)) pointValues_ += field.components;
    limitBy({kShapeFloor, options.envelopeTolerance * cost_.diagonal(), kNormalCosine});
  }

  Result<FusionHistory> run() {
    runBands();
    goal_ = target_;
    while (mesh_.liveTetrahedra() > target_) {
      const std::size_t before = mesh_.liveTetrahedra();
      runLevels();
      if (level_ == kMaxLevels && mesh_.liveTetrahedra() > target_)
        return fail(ErrorCode::kLimitExceeded,
                    "4,096 levels do not reach the target; ask for more cells with --target-ratio");
      if (isWorth(kWorthAnotherPass, before)) continue;
      if (relaxed_) break;
      relaxed_ = true;
      limitBy({0, options_.envelopeTolerance * cost_.diagonal(), -1});
    }
    FusionHistory history = mesh_.takeHistory(level_);
    history.bands = band_.take();
    return history;
  }

 private:
  // A band halves the mesh, or does what its nodes leave it at a fair price: inside small nodes
  // half would cost far more than it does in the whole.
  void runBands() {
    while (mesh_.liveTetrahedra() > target_ &&
           band_.bands() < std::min<std::size_t>(band_.depth(), options_.bands.most)) {
      const std::uint32_t firstLevel = level_;
      goal_ = std::max(target_, mesh_.liveTetrahedra() / 2);
      findCandidates();
      dearest_ = keyAt(options_.bands.dearest);
      band_.begin(mesh_);
      runLevels();
      dearest_ = std::numeric_limits<float>::infinity();
      if (!band_.end(firstLevel, level_)) break;
    }
  }

  /// The key that this fraction of the vertices' best candidates does not pass.
  float keyAt(double fraction) {
    std::vector<float> keys;
    for (const VertexId v : vertices_)
      if (const Candidate* best = candidates_.best(v)) keys.push_back(best->key);
    if (keys.empty()) return 0;
    const auto at =
        keys.begin() + static_cast<std::ptrdiff_t>(fraction * static_cast<double>(keys.size() - 1));
    std::nth_element(keys.begin(), at, keys.end());
    return *at;
  }

  // From all candidates anew to the goal, or until nothing is left to try.
  void runLevels() {
    findCandidates();
    for (std::size_t before = mesh_.liveTetrahedra();
         before > goal_ && level_ < kMaxLevels && runLevel(); before = mesh_.liveTetrahedra())
      if (std::isfinite(dearest_) && !isWorth(kWorthAnotherLevel, before)) return;
  }

  /// At least this fraction of the cells that were there before is gone.
  [[nodiscard]] bool isWorth(double fraction, std::size_t before) const {
    return static_cast<double>(before - mesh_.liveTetrahedra()) >=
           fraction * static_cast<double>(before);
  }

  void limitBy(const FusionLimits& limits) {
    proposers_.clear();
    for (std::size_t i = 0; i < workers_.count(); ++i)
      proposers_.push_back(std::make_unique<FusionProposer>(
          mesh_, cost_, touched_, band_, limits,
          FusionPointOptions{options_.placement, options_.shapeWeight}));
  }

  void findCandidates() {
    candidates_.clear();
    touched_.resize(mesh_.vertexSlots());
    vertices_.clear();
    for (VertexId v = 0; v < mesh_.vertexSlots(); ++v)
      if (mesh_.alive(v) && !mesh_.singular(v)) vertices_.push_back(v);
    candidates_.reserve(kMaxCandidates * vertices_.size());
    collect(vertices_, [&](FusionProposer& proposer, std::size_t i, std::vector<Candidate>& found) {
      proposer.candidatesOf(vertices_[i], found);
    });
  }

  /// The candidates of these vertices, found in parallel, kept in order: find(proposer, index,
  /// found).
  template <class Find>
  void collect(std::span<const VertexId> vertices, const Find& find) {
    found_.resize(std::max(found_.size(), std::min(vertices.size(), kCollected)));
    for (std::size_t first = 0; first < vertices.size(); first += kCollected) {
      const auto part = vertices.subspan(first, std::min(kCollected, vertices.size() - first));
      workers_.forEach(part.size(), kGrain, [&](std::size_t worker, std::size_t i) {
        find(*proposers_[worker], first + i, found_[i]);
      });
      candidates_.set(part, found_, workers_);
    }
  }

  /// False when nothing is left to try.
  bool runLevel() {
    fillQueue();
    if (entries_.empty()) return false;
    levelStart_ = touched_.now();
    fused_.clear();
    links_.clear(), linkEnds_.clear();
    proposals_.begin(entries_, limit_, levelStart_, proposers_);
    workers_.beside([this](std::size_t worker) { proposals_.serve(worker); }, [this] { decide(); });
    doFusions();
    proposals_.end();
    if (!fused_.empty()) ++level_;
    vertices_.insert(vertices_.end(), fused_.begin(), fused_.end());
    collect(fused_, [&](FusionProposer& proposer, std::size_t i, std::vector<Candidate>& found) {
      if (i + kFusedAhead < fused_.size()) prefetchFused(i + kFusedAhead);
      proposer.candidatesOf(fused_[i], linkOf(i), found);
    });
    candidates_.compact();
    if (options_.progress) options_.progress(progress());
    return true;
  }

  // What is fused in this level. The mesh changes afterwards: nothing that is decided here depends
  // on it (ALGORITHM.md, "Threads").
  void decide() {
    struct Stop {
      LevelProposals& proposals;
      ~Stop() { proposals.stop(); }
    } const stop{proposals_};
    while (nextKey() <= limit_ && mesh_.liveTetrahedra() - going_ > goal_) {
      throwIfStopped(options_.stop);
      const bool isEntry = isEntryNext();
      const VertexId owner = isEntry ? entries_[next_++].owner : popBack();
      if (isLocked(owner)) continue;
      if (isEntry) proposals_.comeTo(next_ - 1);
      process(owner);
    }
  }

  // Asks the memory for what the candidates of a fused vertex are found from.
  void prefetchFused(std::size_t i) const {
    mesh_.prefetchStar(fused_[i]), cost_.prefetch(fused_[i]);
    for (const VertexId v : linkOf(i))
      if (v != kGhost) cost_.prefetch(v), mesh_.prefetchPoint(v);
  }

  // The vertices whose best candidate is within the level's limit, cheapest first. Those that have
  // none and will have none are left out for good.
  void fillQueue() {
    queue_.clear();
    entries_.resize(vertices_.size());
    filled_.resize((vertices_.size() + kFilled - 1) / kFilled);
    const float most = std::min(dearest_, std::numeric_limits<float>::max());
    workers_.forRuns(vertices_.size(), kFilled, [&](std::size_t begin, std::size_t end) {
      Filled filled{begin, begin};
      for (std::size_t i = begin; i < end; ++i) {
        if (i + 2 * kListsAhead < end) candidates_.prefetch(vertices_[i + 2 * kListsAhead]);
        if (i + kListsAhead < end) candidates_.prefetchBest(vertices_[i + kListsAhead]);
        const VertexId v = vertices_[i];
        // what its old neighbours forbade the new ones may allow
        if (candidates_.hasFailed(v) && isLocked(v)) candidates_.restart(v);
        dropDead(v);
        const Candidate* best = candidates_.best(v);
        vertices_[filled.vertices] = v;
        filled.vertices += !candidates_.isEmpty(v);
        entries_[filled.entries] = {best ? best->key : 0, v};
        filled.entries += best != nullptr && best->key <= most;
      }
      filled_[begin / kFilled] = filled;
    });
    joinRuns(vertices_, &Filled::vertices);
    joinRuns(entries_, &Filled::entries);
    next_ = 0;
    if (entries_.empty()) return;
    // What a band can afford it will do, so that the order counts for less there than the number of
    // levels.
    limit_ = sorter_.keepCheapest(
        entries_, std::isinf(dearest_) ? kLevelQuantile : options_.bands.levelQuantile);
  }

  // What is left of each run moves up to the one before.
  template <class T>
  void joinRuns(std::vector<T>& all, std::size_t Filled::* end) const {
    const auto place = [&](std::size_t i) { return all.begin() + static_cast<std::ptrdiff_t>(i); };
    auto to = filled_.empty() ? all.begin() : place(filled_[0].*end);
    for (std::size_t run = 1; run < filled_.size(); ++run)
      to = std::copy(place(run * kFilled), place(filled_[run].*end), to);
    all.erase(to, all.end());
  }

  // The queue is the sorted entries and a heap of those that came back.
  [[nodiscard]] float nextKey() const {
    const float key =
        next_ < entries_.size() ? entries_[next_].key : std::numeric_limits<float>::infinity();
    return queue_.empty() ? key : std::min(key, queue_.top().key);
  }
  [[nodiscard]] bool isEntryNext() const {
    return next_ < entries_.size() && (queue_.empty() || queue_.top() < entries_[next_]);
  }
  VertexId popBack() {
    const VertexId owner = queue_.top().owner;
    queue_.pop();
    return owner;
  }

  void dropDead(VertexId v) {
    while (const Candidate* best = candidates_.best(v)) {
      if (mesh_.alive(best->partner)) return;
      candidates_.drop(v);
    }
  }

  // A vertex that a fusion of this level touched waits for the next one: levels are independent
  // sets.
  [[nodiscard]] bool isLocked(VertexId v) const { return touched_.since(v, levelStart_); }

  // Puts the owner back with its best remaining candidate, unless that waits for a later level.
  void requeue(VertexId owner) {
    dropDead(owner);
    const Candidate* best = candidates_.best(owner);
    if (best && best->key <= limit_)
      queue_.push({best->key, owner});
    else
      proposals_.giveBack(owner);
  }

  /// What comes of the owner's best candidate, made now unless what was found in this level still
  /// holds.
  Outcome propose(VertexId owner, VertexId partner, float most) {
    Proposal& proposal = proposals_.of(owner);
    if (const auto illegal =
            std::ranges::find(proposal.illegal, partner, &Proposal::Illegal::partner);
        illegal != proposal.illegal.end())
      return {nullptr, illegal->price};
    const auto changed = [&](VertexId v) { return touched_.since(v, proposal.madeAfter); };
    const auto isWhole = [&] { return std::min(proposal.edgeCost, most) <= proposal.most; };
    const bool holds =
        proposal.partner == partner &&
        (proposal.isPriceAll ? proposal.price > most
                             : isWhole() && std::ranges::none_of(proposal.companions, changed));
    if (!holds && !proposers_[0]->propose(owner, candidates_.remaining(owner), most,
                                          {levelStart_, touched_.now()}, proposal))
      return {nullptr, proposal.illegal.back().price};
    return {&proposal,
            proposal.price > most ? proposal.price : static_cast<float>(proposal.where.cost)};
  }

  void process(VertexId owner) {
    const Candidate candidate = *candidates_.best(owner);
    assert(mesh_.alive(candidate.partner));  // or the owner would be locked
    if (isLocked(candidate.partner)) return;
    // Dearer than this, it waits for what costs less.
    const float most = std::min(limit_, std::max(kDearer * candidate.key, nextKey()));
    const Outcome outcome = propose(owner, candidate.partner, most);
    if (outcome.cost <= most && outcome.proposal) return decideOn(owner, *outcome.proposal);
    outcome.cost > most ? candidates_.raise(owner, outcome.cost) : candidates_.fail(owner);
    requeue(owner);
  }

  void decideOn(VertexId owner, const Proposal& proposal) {
    for (const VertexId v : proposal.prey.vertices()) touched_.touch(v);
    for (const VertexId v : proposal.star.link)
      if (v != kGhost) touched_.touch(v);
    touched_.next();
    going_ += proposal.tetrahedra;
    planned_.push_back(
        {proposal.prey, proposal.where.point, proposal.where.outside, &proposal.star});
    if (workers_.count() > 1) return;
    doFusions();  // while the processor has the star near
    proposals_.giveBack(owner);
  }

  // Does what was decided on, in that order.
  void doFusions() {
    const std::size_t count = planned_.size(), slots = mesh_.vertexSlots(), before = fused_.size();
    for (std::size_t i = 0; i < count; ++i) {
      fused_.push_back(static_cast<VertexId>(slots + i));
      linkEnds_.push_back((linkEnds_.empty() ? 0 : linkEnds_.back()) +
                          planned_[i].star->link.size());
      band_.fused(planned_[i].prey.vertex[0]);
    }
    links_.resize(linkEnds_.empty() ? 0 : linkEnds_.back());
    integers_.resize(count * pointValues_);
    cost_.makeRoom(slots + count);
    touched_.resize(slots + count);
    const auto valuesOf = [&](std::size_t i, VertexId fused) -> std::span<const std::int32_t> {
      if (i + kFusedAhead < count) prefetchPrey(planned_[i + kFusedAhead].prey);
      for (const VertexId v : planned_[i].prey.vertices()) candidates_.forget(v);
      const std::vector<VertexId>& link = planned_[i].star->link;
      std::ranges::copy(
          link, links_.begin() + static_cast<std::ptrdiff_t>(linkEnds_[before + i] - link.size()));
      const auto integers = std::span(integers_).subspan(i * pointValues_, pointValues_);
      fuseCosts(planned_[i].prey, fused, planned_[i].point, integers);
      return integers;
    };
    mesh_.fuse(planned_, level_, std::cref(valuesOf), &workers_);
    planned_.clear();
    going_ = 0;
  }

  void prefetchPrey(const Prey& prey) const {
    for (const VertexId v : prey.vertices()) {
      cost_.prefetch(v), candidates_.prefetch(v);
      for (std::size_t f = 0; f < mesh_.fields().size(); ++f)
        if (!isCellField(mesh_.fields()[f])) prefetch(mesh_.values(f, v).data());
    }
  }

  void fuseCosts(const Prey& prey, VertexId fused, const LatticePoint& point,
                 std::span<std::int32_t> integers) {
    std::array<double, kMaxCostComponents> room;
    const auto values = std::span(room).first(cost_.components());
    cost_.valuesAt(prey, point, values);
    findIntegers(prey, point, values, integers);
    cost_.fuse(prey, fused, point, values);
  }

  /// The link of fused_[i], in which nothing changes until the level ends.
  [[nodiscard]] std::span<const VertexId> linkOf(std::size_t i) const {
    const std::size_t first = i == 0 ? 0 : linkEnds_[i - 1];
    return std::span(links_).subspan(first, linkEnds_[i] - first);
  }

  // The fused vertex's integers: of a field in the cost what the cost says, of the others the
  // nearest prey vertex's.
  void findIntegers(const Prey& prey, const LatticePoint& point, std::span<const double> values,
                    std::span<std::int32_t> integers) const {
    VertexId nearest = prey.vertex[0];
    double least = std::numeric_limits<double>::infinity();
    for (const VertexId v : prey.vertices()) {
      const Vector3 d = mesh_.position(v) - toVector(point);
      if (dot(d, d) < least) least = dot(d, d), nearest = v;
    }
    std::size_t part = 0, component = 0, at = 0;
    for (std::size_t f = 0; f < mesh_.fields().size(); ++f) {
      if (isCellField(mesh_.fields()[f])) continue;
      if (part < cost_.parts().size() && cost_.parts()[part].field == f) {
        for (std::size_t c = 0; c < mesh_.fields()[f].components; ++c)
          integers[at++] = static_cast<std::int32_t>(
              std::floor(values[component++] / cost_.parts()[part].scale + 0.5));
        ++part;
      } else {
        for (const std::int32_t value : mesh_.values(f, nearest)) integers[at++] = value;
      }
    }
  }

  [[nodiscard]] double progress() const {
    const double all = static_cast<double>(original_ - target_);
    // Removal is geometric, so is the bar: the logarithm of what is left.
    if (all <= 0 || target_ == 0) return 1;
    return std::log(static_cast<double>(original_) /
                    static_cast<double>(std::max(mesh_.liveTetrahedra(), target_))) /
           std::log(static_cast<double>(original_) / static_cast<double>(target_));
  }

  const FusionOptions& options_;
  Workers workers_;
  FusionMesh mesh_;
  FusionCost cost_;
  Touched touched_;
  BandNodes band_;
  std::vector<std::unique_ptr<FusionProposer>> proposers_;  // one a worker
  // nothing is left that keeps the limits of beauty; those of validity remain
  bool relaxed_ = false;
  std::size_t original_, target_;
  std::size_t goal_ = 0;  // of the levels in hand: target_, or where the band ends
  std::uint32_t level_ = 0;
  std::uint32_t levelStart_ = 0;    // fusions
  std::vector<VertexId> vertices_;  // alive at the level's start
  Candidates candidates_;
  LevelProposals proposals_{mesh_, cost_, candidates_, touched_};
  std::vector<std::vector<Candidate>> found_;  // collect's own
  std::vector<Filled> filled_;                 // fillQueue's own, by run
  std::vector<QueueEntry> entries_;
  EntrySorter sorter_;
  std::size_t next_ = 0;  // into entries_
  // keys: where the level ends, where the band does
  float limit_ = 0, dearest_ = std::numeric_limits<float>::infinity();
  Queue queue_;
  std::vector<PlannedFusion> planned_;  // decided on, not done yet
  std::size_t going_ = 0;               // tetrahedra that go with them
  std::size_t pointValues_ = 0;         // integers of a vertex, over all point fields
  std::vector<std::int32_t> integers_;  // of planned_, back to back
  std::vector<VertexId> fused_;         // of this level
  std::vector<VertexId> links_;         // theirs, back to back
  std::vector<std::size_t> linkEnds_;
};

Status checkWeights(const LatticeMesh& mesh, const FusionOptions& options) {
  const std::vector<double>& weights = options.cost.fieldWeights;
  if (!weights.empty() && weights.size() != mesh.fields.size())
    return fail(ErrorCode::kBadInput, "there must be one field weight a field");
  const auto bad = [](double w) { return !(w >= 0) || std::isinf(w); };
  if (std::ranges::any_of(weights, bad) || bad(options.cost.boundaryWeight.value_or(0)) ||
      bad(options.shapeWeight))
    return fail(ErrorCode::kBadInput, "weights must be finite and not negative");
  return {};
}

Status checkRegions(const LatticeMesh& mesh, const FusionOptions& options) {
  if (!options.regionField) return {};
  if (*options.regionField >= mesh.fields.size())
    return fail(ErrorCode::kBadInput, "there is no such field of regions");
  const FieldInfo& field = mesh.fields[*options.regionField];
  if (!isCellField(field) || field.components != 1)
    return fail(ErrorCode::kBadInput,
                "field '" + field.name +
                    "' cannot tell regions apart: that takes a cell field of one component");
  if (isFloatType(field.type) || field.step != 1)
    return fail(ErrorCode::kBadInput,
                "field '" + field.name +
                    "' cannot tell regions apart: only integers that are stored exactly can");
  return {};
}

Status check(const LatticeMesh& mesh, const FusionOptions& options) {
  if (mesh.tetrahedra.empty()) return fail(ErrorCode::kBadInput, "the mesh has no tetrahedra");
  if (!(options.targetRatio >= 0 && options.targetRatio <= 1))
    return fail(ErrorCode::kBadInput, "the target ratio must lie in 0..1");
  if (!(options.envelopeTolerance >= 0))
    return fail(ErrorCode::kBadInput, "the envelope tolerance must not be negative");
  if (Status weights = checkWeights(mesh, options); !weights) return weights;
  return checkRegions(mesh, options);
}

}  // namespace

Result<FusionHistory> simplify(const LatticeMesh& mesh, const FusionOptions& options) {
  if (Status checked = check(mesh, options); !checked) return std::unexpected(checked.error());
  return orCancelled([&] { return Simplifier(mesh, options).run(); });
}

Result<FusionHistory> simplify(LatticeMesh&& mesh, const FusionOptions& options) {
  if (Status checked = check(mesh, options); !checked) return std::unexpected(checked.error());
  return orCancelled([&] {
    Simplifier simplifier(mesh, options);
    mesh = {};
    return simplifier.run();
  });
}

}  // namespace qtet
