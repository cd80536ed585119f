#include "simplify/qtetfusion.h"

#include <algorithm>
#include <array>
#include <boost/heap/d_ary_heap.hpp>
#include <cmath>
#include <deque>
#include <limits>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "proto/limits.h"
#include "simplify/band_nodes.h"
#include "simplify/candidates.h"
#include "simplify/fusion_mesh.h"
#include "simplify/fusion_proposer.h"
#include "simplify/queue_entries.h"
#include "simplify/tet_mesh.h"
#include "simplify/workers.h"

namespace qtet {
namespace {

// A level ends where the next key passes this quantile of the keys at its start: about 5 % growth a level, as good as strict order.
constexpr double kLevelQuantile = 0.35;
// A pass over all candidates that removes less than this fraction of the cells is the last.
constexpr double kWorthAnotherPass = 0.002;
// A level of a band that removes less than this fraction of the cells is its last: what is left is dear, and waits for larger nodes.
constexpr double kWorthAnotherLevel = 0.015;
// A fusion that turns out to cost this much more than its key waits for those that cost less.
constexpr float kDearer = 1.25f;
// No new cell may be shaped worse than this, or than a fifth of its star's worst (1 = regular, 0 = flat).
constexpr double kShapeFloor = 1e-4;
// Cosine of the largest angle by which a boundary triangle may turn in one fusion: more, and a fold could hide what the quadric does not see.
constexpr double kNormalCosine = 0.3;

// Vertices whose candidates are found at once, and how many of them a thread takes at a time; of proposals, each dearer and few at once, one.
constexpr std::size_t kCollected = 4096;
constexpr std::size_t kGrain = 8;
constexpr std::size_t kProposalGrain = 1;
// How many entries ahead the memory is asked for lists of candidates, and for what comes of them at most.
constexpr std::size_t kListsAhead = 8;
constexpr std::size_t kMostLooked = 32;
// The same for the candidates of fused vertices.
constexpr std::size_t kFusedAhead = 2;
// Entries of the queue for which threads make proposals ahead: a share of the level's, since a fusion spoils those of its neighbours.
constexpr std::size_t kAheadShare = 128;
constexpr std::size_t kLeastAhead = 32;
constexpr std::size_t kMostAhead = 2048;

using Queue = boost::heap::d_ary_heap<QueueEntry, boost::heap::arity<4>>;

/// Null where the fusion is not legal; that, too, is known only of what costs no more than it may.
struct Outcome {
  const Proposal* proposal;
  float cost;
};

class Simplifier {
 public:
  Simplifier(const LatticeMesh& mesh, const FusionOptions& options)
      : options_(options),
        workers_(options.threads),
        mesh_(mesh, options.regionField.value_or(FusionMesh::kNoRegions), &workers_),
        cost_(mesh_, mesh, options.cost, &workers_),
        band_(options.bands.cellsPerPacket == 0 ? BandNodes() : BandNodes(mesh_, mesh, options.bands.cellsPerPacket)),
        original_(mesh.tetrahedra.size()),
        target_(static_cast<std::size_t>(options.targetRatio * static_cast<double>(original_))),
        values_(cost_.components()) {
    limitBy({kShapeFloor, options.envelopeTolerance * cost_.diagonal(), kNormalCosine});
  }

  Result<FusionHistory> run() {
    runBands();
    goal_ = target_;
    while (mesh_.liveTetrahedra() > target_) {
      const std::size_t before = mesh_.liveTetrahedra();
      runLevels();
      if (level_ == kMaxLevels && mesh_.liveTetrahedra() > target_)
        return fail(ErrorCode::kLimitExceeded, "4,096 levels do not reach the target; ask for more cells with --target-ratio");
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
  // A band halves the mesh, or does what its nodes leave it at a fair price: inside small nodes half would cost far more than it does in the whole.
  void runBands() {
    while (mesh_.liveTetrahedra() > target_ && band_.bands() < std::min<std::size_t>(band_.depth(), options_.bands.most)) {
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
    const auto at = keys.begin() + static_cast<std::ptrdiff_t>(fraction * static_cast<double>(keys.size() - 1));
    std::nth_element(keys.begin(), at, keys.end());
    return *at;
  }

  // From all candidates anew to the goal, or until nothing is left to try.
  void runLevels() {
    findCandidates();
    for (std::size_t before = mesh_.liveTetrahedra(); before > goal_ && level_ < kMaxLevels && runLevel(); before = mesh_.liveTetrahedra())
      if (std::isfinite(dearest_) && !isWorth(kWorthAnotherLevel, before)) return;
  }

  /// At least this fraction of the cells that were there before is gone.
  [[nodiscard]] bool isWorth(double fraction, std::size_t before) const {
    return static_cast<double>(before - mesh_.liveTetrahedra()) >= fraction * static_cast<double>(before);
  }

  void limitBy(const FusionLimits& limits) {
    proposers_.clear();
    for (std::size_t i = 0; i < workers_.count(); ++i)
      proposers_.push_back(std::make_unique<FusionProposer>(mesh_, cost_, touched_, band_, limits, FusionPointOptions{options_.placement, options_.shapeWeight}));
  }

  void findCandidates() {
    candidates_.clear();
    makeRoom();
    vertices_.clear();
    for (VertexId v = 0; v < mesh_.vertexSlots(); ++v)
      if (mesh_.alive(v) && !mesh_.singular(v)) vertices_.push_back(v);
    collect(vertices_,
            [&](FusionProposer& proposer, std::size_t i, std::vector<Candidate>& found) { proposer.candidatesOf(vertices_[i], found); });
  }

  void makeRoom() {
    touched_.resize(mesh_.vertexSlots());
    proposalOf_.resize(mesh_.vertexSlots(), kNone);
  }

  /// The candidates of these vertices, found in parallel, kept in order: find(proposer, index, found).
  template <class Find>
  void collect(std::span<const VertexId> vertices, const Find& find) {
    found_.resize(std::max(found_.size(), std::min(vertices.size(), kCollected)));
    for (std::size_t first = 0; first < vertices.size(); first += kCollected) {
      const auto part = vertices.subspan(first, std::min(kCollected, vertices.size() - first));
      workers_.forEach(part.size(), kGrain, [&](std::size_t worker, std::size_t i) { find(*proposers_[worker], first + i, found_[i]); });
      for (std::size_t i = 0; i < part.size(); ++i) candidates_.set(part[i], found_[i]);
    }
  }

  /// False when nothing is left to try.
  bool runLevel() {
    fillQueue();
    if (entries_.empty()) return false;
    levelStart_ = fusions_;
    fused_.clear();
    links_.clear(), linkEnds_.clear();
    while (nextKey() <= limit_ && mesh_.liveTetrahedra() > goal_) {
      if (next_ >= proposedTo_) proposeAhead();
      const VertexId owner = pop();
      if (isLocked(owner)) continue;
      lookAhead();
      process(owner);
    }
    for (const VertexId v : withProposal_) proposalOf_[v] = kNone;
    withProposal_.clear();
    proposalsUsed_ = 0, spareProposals_.clear();
    if (fusions_ > levelStart_) ++level_;
    vertices_.insert(vertices_.end(), fused_.begin(), fused_.end());
    collect(fused_, [&](FusionProposer& proposer, std::size_t i, std::vector<Candidate>& found) {
      if (i + kFusedAhead < fused_.size()) prefetchFused(i + kFusedAhead);
      proposer.candidatesOf(fused_[i], linkOf(i), found);
    });
    candidates_.compact();
    if (options_.progress) options_.progress(progress());
    return true;
  }

  // Asks the memory for what the candidates of a fused vertex are found from.
  void prefetchFused(std::size_t i) const {
    mesh_.prefetchStar(fused_[i]), cost_.prefetch(fused_[i]);
    for (const VertexId v : linkOf(i))
      if (v != kGhost) cost_.prefetch(v), mesh_.prefetchPoint(v);
  }

  // The vertices whose best candidate is within the level's limit, cheapest first.
  void fillQueue() {
    entries_.clear();
    queue_.clear();
    std::erase_if(vertices_, [&](VertexId v) { return !mesh_.alive(v); });
    entries_.resize(vertices_.size());
    workers_.forRuns(vertices_.size(), kCollected, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const VertexId v = vertices_[i];
        if (i + kListsAhead < end) candidates_.prefetchBest(vertices_[i + kListsAhead]);
        dropDead(v);
        const Candidate* best = candidates_.best(v);
        entries_[i] = {best ? best->key : std::numeric_limits<float>::infinity(), v};
      }
    });
    std::erase_if(entries_, [&](const QueueEntry& e) { return e.key > dearest_ || std::isinf(e.key); });
    next_ = proposedTo_ = looked_ = 0;
    soon_.fill({});
    if (entries_.empty()) return;
    // What a band can afford it will do, so that the order counts for less there than the number of levels.
    limit_ = sorter_.keepCheapest(entries_, std::isinf(dearest_) ? kLevelQuantile : options_.bands.levelQuantile);
    ahead_ = std::clamp(entries_.size() / kAheadShare, kLeastAhead, kMostAhead);
  }

  // The queue is the sorted entries and a heap of those that came back.
  [[nodiscard]] float nextKey() const {
    const float key = next_ < entries_.size() ? entries_[next_].key : std::numeric_limits<float>::infinity();
    return queue_.empty() ? key : std::min(key, queue_.top().key);
  }
  VertexId pop() {
    if (next_ < entries_.size() && (queue_.empty() || queue_.top() < entries_[next_])) return entries_[next_++].owner;
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

  // The queue's order has nothing to do with where things lie: what its next proposals need is asked for in steps, each of which needs the one before.
  // Entries that are locked already are passed over, so that a step is a proposal.
  void lookAhead() {
    if (looked_ >= next_ + kMostLooked) return;
    VertexId owner = kNone;
    while (owner == kNone && looked_ < entries_.size()) {
      if (looked_ + kListsAhead < entries_.size()) {
        const VertexId v = entries_[looked_ + kListsAhead].owner;
        touched_.prefetch(v), candidates_.prefetch(v), mesh_.prefetchVertex(v);
      }
      const VertexId v = entries_[looked_++].owner;
      if (!isLocked(v)) owner = v;
    }
    const auto stepsAgo = [this](std::size_t steps) -> Soon& { return soon_[(soonAt_ - steps) % soon_.size()]; };
    ++soonAt_;
    stepsAgo(0) = {owner, kNone};
    if (owner != kNone) candidates_.prefetchBest(owner), mesh_.prefetchList(owner), cost_.prefetchSlot(owner), mesh_.prefetchPoint(owner);
    if (Soon& soon = stepsAgo(2); soon.owner != kNone) {
      mesh_.prefetchStar(soon.owner), mesh_.prefetchPlanes(soon.owner), cost_.prefetch(soon.owner);
      if (const Candidate* best = candidates_.best(soon.owner)) {
        soon.partner = best->partner;
        touched_.prefetch(soon.partner), mesh_.prefetchVertex(soon.partner), cost_.prefetchSlot(soon.partner), mesh_.prefetchPoint(soon.partner);
      }
    }
    if (const VertexId v = stepsAgo(4).partner; v != kNone) mesh_.prefetchList(v), cost_.prefetch(v);
    if (const VertexId v = stepsAgo(5).partner; v != kNone) mesh_.prefetchStar(v), mesh_.prefetchPlanes(v);
  }

  // A vertex that a fusion of this level touched waits for the next one: levels are independent sets.
  [[nodiscard]] bool isLocked(VertexId v) const { return touched_.since(v, levelStart_); }

  // Puts the owner back with its best remaining candidate, unless that waits for a later level.
  void requeue(VertexId owner) {
    dropDead(owner);
    const Candidate* best = candidates_.best(owner);
    if (best && best->key <= limit_)
      queue_.push({best->key, owner});
    else
      giveBack(owner);
  }

  // With threads: proposals for the next entries, made in parallel. They are used as long as nothing they rely on is touched, so that the
  // outcome is that of one thread.
  void proposeAhead() {
    proposedTo_ = std::min(entries_.size(), next_ + ahead_);
    if (workers_.count() == 1) return;
    jobs_.clear();
    for (std::size_t i = next_; i < proposedTo_; ++i) {
      const VertexId owner = entries_[i].owner;
      if (isLocked(owner) || !mesh_.alive(owner)) continue;
      const Candidate* best = candidates_.best(owner);
      if (best && mesh_.alive(best->partner) && !isLocked(best->partner)) jobs_.push_back({owner, &proposalFor(owner)});
    }
    workers_.forEach(jobs_.size(), kProposalGrain, [&](std::size_t worker, std::size_t i) {
      const auto [owner, proposal] = jobs_[i];
      // Where the best is not legal, the next one is wanted soon.
      for (auto rest = candidates_.remaining(owner); !rest.empty() && rest[0].key <= limit_; rest = rest.subspan(1)) {
        if (!mesh_.alive(rest[0].partner) || isLocked(rest[0].partner)) break;
        // No dearer than the one thread would go on with at once: later the owner's other candidates are not what they are now.
        const float most = std::min(limit_, kDearer * rest[0].key);
        if (proposers_[worker]->propose(owner, rest, most, {levelStart_, fusions_}, *proposal)) break;
      }
    });
  }

  Proposal& proposalFor(VertexId owner) {
    if (proposalOf_[owner] == kNone) {
      proposalOf_[owner] = spareProposal();
      withProposal_.push_back(owner);
      proposals_[proposalOf_[owner]].illegal.clear();
      proposals_[proposalOf_[owner]].partner = kGhost;
    }
    return proposals_[proposalOf_[owner]];
  }

  // The one that was given back last, since the processor has it near.
  std::uint32_t spareProposal() {
    if (!spareProposals_.empty()) {
      const std::uint32_t last = spareProposals_.back();
      spareProposals_.pop_back();
      return last;
    }
    if (proposals_.size() == proposalsUsed_) proposals_.emplace_back();
    return proposalsUsed_++;
  }

  // Nobody asks for it again in this level.
  void giveBack(VertexId owner) {
    if (proposalOf_[owner] == kNone) return;
    spareProposals_.push_back(proposalOf_[owner]);
    proposalOf_[owner] = kNone;
  }

  /// What comes of the owner's best candidate, made now unless what was found in this level still holds.
  Outcome propose(VertexId owner, VertexId partner, float most) {
    Proposal& proposal = proposalFor(owner);
    if (const auto illegal = std::ranges::find(proposal.illegal, partner, &Proposal::Illegal::partner); illegal != proposal.illegal.end())
      return {nullptr, illegal->price};
    const auto changed = [&](VertexId v) { return touched_.since(v, proposal.madeAfter); };
    const auto isWhole = [&] { return std::min(proposal.edgeCost, most) <= proposal.most; };
    const bool holds = proposal.partner == partner &&
                       (proposal.isPriceAll ? proposal.price > most : isWhole() && std::ranges::none_of(proposal.companions, changed));
    if (!holds && !proposers_[0]->propose(owner, candidates_.remaining(owner), most, {levelStart_, fusions_}, proposal))
      return {nullptr, proposal.illegal.back().price};
    return {&proposal, proposal.price > most ? proposal.price : static_cast<float>(proposal.where.cost)};
  }

  void process(VertexId owner) {
    const Candidate candidate = *candidates_.best(owner);
    if (!mesh_.alive(candidate.partner)) return requeue(owner);
    if (isLocked(candidate.partner)) return;
    // Dearer than this, it waits for what costs less.
    const float most = std::min(limit_, std::max(kDearer * candidate.key, nextKey()));
    const Outcome outcome = propose(owner, candidate.partner, most);
    if (outcome.cost <= most && outcome.proposal) {
      fuse(*outcome.proposal);
      return giveBack(owner);
    }
    outcome.cost > most ? candidates_.raise(owner, outcome.cost) : candidates_.fail(owner);
    requeue(owner);
  }

  void fuse(const Proposal& proposal) {
    const Prey& prey = proposal.prey;
    const LatticePoint& point = proposal.where.point;
    for (const VertexId v : proposal.star.link)
      if (v != kGhost) mesh_.prefetchVertex(v), touched_.prefetch(v), candidates_.prefetch(v);
    cost_.valuesAt(prey, point, values_);
    fuseIntegers(prey, point);
    cost_.fuse(prey, point, values_);
    const VertexId fused = mesh_.fuse(prey, {point, integers_, proposal.where.outside}, proposal.star, level_);
    band_.fused(prey.vertex[0]);
    makeRoom();
    touched_.touch(fused, ++fusions_);
    for (const VertexId v : prey.vertices()) touched_.touch(v, fusions_), candidates_.forget(v);
    for (const VertexId v : proposal.star.link) {
      if (v == kGhost) continue;
      touched_.touch(v, fusions_);
      candidates_.restart(v);  // what its old neighbours forbade its new ones may allow
    }
    fused_.push_back(fused);
    links_.insert(links_.end(), proposal.star.link.begin(), proposal.star.link.end());
    linkEnds_.push_back(links_.size());
  }

  /// The link of fused_[i], in which nothing changes until the level ends.
  [[nodiscard]] std::span<const VertexId> linkOf(std::size_t i) const {
    const std::size_t first = i == 0 ? 0 : linkEnds_[i - 1];
    return std::span(links_).subspan(first, linkEnds_[i] - first);
  }

  // The fused vertex's integers: of a field in the cost what the cost says, of the others the nearest prey vertex's.
  void fuseIntegers(const Prey& prey, const LatticePoint& point) {
    VertexId nearest = prey.vertex[0];
    double least = std::numeric_limits<double>::infinity();
    for (const VertexId v : prey.vertices()) {
      const Vector3 d = mesh_.position(v) - toVector(point);
      if (dot(d, d) < least) least = dot(d, d), nearest = v;
    }
    integers_.clear();
    std::size_t part = 0, component = 0;
    for (std::size_t f = 0; f < mesh_.fields().size(); ++f) {
      if (isCellField(mesh_.fields()[f])) continue;
      if (part < cost_.parts().size() && cost_.parts()[part].field == f) {
        for (std::size_t c = 0; c < mesh_.fields()[f].components; ++c)
          integers_.push_back(static_cast<std::int32_t>(std::floor(values_[component++] / cost_.parts()[part].scale + 0.5)));
        ++part;
      } else {
        const auto values = mesh_.values(f, nearest);
        integers_.insert(integers_.end(), values.begin(), values.end());
      }
    }
  }

  [[nodiscard]] double progress() const {
    const double all = static_cast<double>(original_ - target_);
    // Removal is geometric, so is the bar: the logarithm of what is left.
    if (all <= 0 || target_ == 0) return 1;
    return std::log(static_cast<double>(original_) / static_cast<double>(std::max(mesh_.liveTetrahedra(), target_))) /
           std::log(static_cast<double>(original_) / static_cast<double>(target_));
  }

  static constexpr std::uint32_t kNone = ~0u;

  const FusionOptions& options_;
  Workers workers_;
  FusionMesh mesh_;
  FusionCost cost_;
  Touched touched_;
  BandNodes band_;
  std::vector<std::unique_ptr<FusionProposer>> proposers_;  // one a worker
  bool relaxed_ = false;                                    // nothing is left that keeps the limits of beauty; those of validity remain
  std::size_t original_, target_;
  std::size_t goal_ = 0;  // of the levels in hand: target_, or where the band ends
  std::uint32_t level_ = 0;
  std::uint32_t fusions_ = 0, levelStart_ = 0;
  std::vector<VertexId> vertices_;  // alive at the level's start
  Candidates candidates_;
  std::vector<std::vector<Candidate>> found_;  // collect's own
  std::vector<QueueEntry> entries_;
  EntrySorter sorter_;
  std::size_t next_ = 0, proposedTo_ = 0, ahead_ = 0;  // into entries_
  struct Soon {
    VertexId owner = kNone, partner = kNone;  // of a proposal
  };
  std::array<Soon, 8> soon_;                  // those that were looked at last
  std::size_t looked_ = 0, soonAt_ = 0;       // into entries_, into soon_
  float limit_ = 0, dearest_ = std::numeric_limits<float>::infinity();  // keys: where the level ends, where the band does
  Queue queue_;
  std::vector<VertexId> fused_;  // of this level
  std::vector<VertexId> links_;  // theirs, back to back
  std::vector<std::size_t> linkEnds_;
  std::deque<Proposal> proposals_;
  std::vector<std::uint32_t> proposalOf_;  // by vertex, into proposals_
  std::vector<VertexId> withProposal_;
  std::uint32_t proposalsUsed_ = 0;
  std::vector<std::uint32_t> spareProposals_;  // of those
  std::vector<std::pair<VertexId, Proposal*>> jobs_;
  std::vector<double> values_;
  std::vector<std::int32_t> integers_;
};

Status checkWeights(const LatticeMesh& mesh, const FusionOptions& options) {
  const std::vector<double>& weights = options.cost.fieldWeights;
  if (!weights.empty() && weights.size() != mesh.fields.size()) return fail(ErrorCode::kBadInput, "there must be one field weight a field");
  const auto bad = [](double w) { return !(w >= 0) || std::isinf(w); };
  if (std::ranges::any_of(weights, bad) || bad(options.cost.hullWeight.value_or(0)) || bad(options.shapeWeight))
    return fail(ErrorCode::kBadInput, "weights must be finite and not negative");
  return {};
}

Status checkRegions(const LatticeMesh& mesh, const FusionOptions& options) {
  if (!options.regionField) return {};
  if (*options.regionField >= mesh.fields.size()) return fail(ErrorCode::kBadInput, "there is no such field of regions");
  const FieldInfo& field = mesh.fields[*options.regionField];
  if (!isCellField(field) || field.components != 1)
    return fail(ErrorCode::kBadInput, "field '" + field.name + "' cannot tell regions apart: that takes a cell field of one component");
  if (isFloatType(field.type) || field.step != 1)
    return fail(ErrorCode::kBadInput, "field '" + field.name + "' cannot tell regions apart: only integers that are stored exactly can");
  return {};
}

Status check(const LatticeMesh& mesh, const FusionOptions& options) {
  if (mesh.tetrahedra.empty()) return fail(ErrorCode::kBadInput, "the mesh has no tetrahedra");
  if (!(options.targetRatio >= 0 && options.targetRatio <= 1)) return fail(ErrorCode::kBadInput, "the target ratio must lie in 0..1");
  if (!(options.envelopeTolerance >= 0)) return fail(ErrorCode::kBadInput, "the envelope tolerance must not be negative");
  if (Status weights = checkWeights(mesh, options); !weights) return weights;
  return checkRegions(mesh, options);
}

}  // namespace

Result<FusionHistory> simplify(const LatticeMesh& mesh, const FusionOptions& options) {
  if (Status checked = check(mesh, options); !checked) return std::unexpected(checked.error());
  return Simplifier(mesh, options).run();
}

Result<FusionHistory> simplify(LatticeMesh&& mesh, const FusionOptions& options) {
  if (Status checked = check(mesh, options); !checked) return std::unexpected(checked.error());
  Simplifier simplifier(mesh, options);
  mesh = {};
  return simplifier.run();
}

}  // namespace qtet
