#include "simplify/fuse/qtetfusion.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <memory>
#include <utility>
#include <vector>

#include "proto/limits.h"
#include "simplify/fuse/fusion_proposer.h"
#include "simplify/fuse/fusion_state.h"
#include "simplify/fuse/level_decider.h"
#include "simplify/fuse/level_fusions.h"
#include "simplify/fuse/level_queue.h"
#include "simplify/fuse/live_boundary.h"
#include "simplify/fuse/open_vertices.h"
#include "simplify/legality/allowed_space.h"
#include "simplify/mesh/moved_place.h"
#include "simplify/mesh/stopping.h"
#include "simplify/mesh/tet_mesh.h"
#include "simplify/mesh/workers.h"

namespace qtet {
namespace {

// A level ends where the next key passes this quantile of the keys at its start. That gives about 5
// % growth a level, as good as strict order.
constexpr double kLevelQuantile = 0.35;
// A pass over all candidates that removes less than this fraction of the cells is the last.
constexpr double kWorthAnotherPass = 0.002;
// So many levels that together remove less than this fraction of the cells are the last. The rest
// is thin, or of a topology that must stay.
constexpr std::size_t kLevelsOfAStall = 8;
constexpr double kWorthAStallsLevels = 0.02;
// No new cell may be shaped worse than this, or than a fifth of its star's worst (1 = regular, 0 =
// flat).
constexpr double kShapeFloor = 1e-4;
// Cosine of the largest angle by which a boundary triangle may turn in one fusion. If it turned
// more, a fold could hide what the quadric does not see.
constexpr double kNormalCosine = 0.3;

class Simplifier {
 public:
  Simplifier(const LatticeMesh& mesh, const FusionOptions& options)
      : options_(options),
        cells_(mesh.tetrahedra.size()),
        target_(baseCellsOf(options, cells_)),
        displacements_(sampledDisplacements(mesh, options.checkedInstants)),
        workers_(options.threads, options.stop),
        state_(mesh, options.regionField.value_or(FusionMesh::kNoRegions), options.cost, workers_) {
    state_.keep(options.kept);
    limitBy(kShapeFloor, kNormalCosine);
  }

  Result<FusionHistory> run() {
    bool isRelaxed = false;  // the limits of validity alone remain, those of beauty do not
    while (live() > target_) {
      const std::size_t before = live();
      const bool stalls = !runLevels();
      if (levels_ == kMaxLevels && live() > target_)
        return fail(ErrorCode::kLimitExceeded,
                    "4,096 levels do not reach the target; ask for more cells with `baseCells`");
      if (!stalls && isWorth(kWorthAnotherPass, before)) continue;
      if (isRelaxed) break;
      isRelaxed = true;
      limitBy(0, -1);
    }
    return state_.takeHistory(levels_);
  }

 private:
  /// From all candidates to the target, or until nothing is left to try. False: it stalls, and
  /// starting from all candidates again would not help.
  bool runLevels() {
    open_.findAll();
    std::deque<std::size_t> before{live()};
    while (live() > target_ && levels_ < kMaxLevels && runLevel()) {
      if (before.size() == kLevelsOfAStall && !isWorth(kWorthAStallsLevels, before.front()))
        return false;
      before.push_back(live());
      if (before.size() > kLevelsOfAStall) before.pop_front();
    }
    return true;
  }

  /// False when nothing is left to try.
  bool runLevel() {
    open_.fill(queue_.refill());
    if (queue_.entries().empty()) return false;
    queue_.begin(kLevelQuantile);
    fusions_.begin(levels_);
    decider_.run(queue_, fusions_, target_);
    if (!fusions_.fused().empty()) ++levels_;
    open_.add(fusions_);
    if (options_.progress) options_.progress(progress());
    return true;
  }

  [[nodiscard]] std::size_t live() const { return state_.mesh().liveTetrahedra(); }

  /// Whether at least this fraction of the cells that were there before is gone.
  [[nodiscard]] bool isWorth(double fraction, std::size_t before) const {
    return static_cast<double>(before - live()) >= fraction * static_cast<double>(before);
  }

  /// Limits fusions by the worst shape of a cell, and the cosine of the largest turn of a boundary
  /// triangle.
  void limitBy(double shapeFloor, double normalCosine) {
    const FusionLimits limits{shapeFloor, allowed_.get(), normalCosine, displacements_};
    proposers_.clear();
    for (std::size_t i = 0; i < workers_.count(); ++i)
      proposers_.push_back(std::make_unique<FusionProposer>(
          state_.mesh(), state_.cost(), state_.changes(), limits,
          FusionPointOptions{options_.placement, options_.shapeWeight, displacements_}));
  }

  [[nodiscard]] double progress() const {
    const double all = static_cast<double>(cells_ - target_);
    // Removal is geometric, so is the bar: the logarithm of what is left.
    if (all <= 0 || target_ == 0) return 1;
    return std::log(static_cast<double>(cells_) / static_cast<double>(std::max(live(), target_))) /
           std::log(static_cast<double>(cells_) / static_cast<double>(target_));
  }

  const FusionOptions& options_;
  std::size_t cells_, target_;  // tetrahedra: at first, and as few as these
  std::vector<std::size_t> displacements_;
  Workers workers_;
  FusionState state_;
  // where fusions may go outside
  const double tolerance_ = options_.envelopeTolerance.value_or(kEnvelopeTolerance);
  const bool mayLeave_ = tolerance_ > 0;
  std::unique_ptr<AllowedSpace> allowed_ =
      mayLeave_
          ? std::make_unique<AllowedSpace>(state_.mesh(), tolerance_* state_.cost().diagonal())
          : nullptr;
  std::unique_ptr<LiveBoundary> boundary_ =
      mayLeave_ ? std::make_unique<LiveBoundary>(state_.mesh()) : nullptr;
  Proposers proposers_;  // one a worker
  OpenVertices open_{state_, workers_, proposers_};
  LevelQueue queue_;
  LevelFusions fusions_{state_, boundary_.get()};
  LevelDecider decider_{state_, workers_, proposers_};
  std::uint32_t levels_ = 0;
};

Status checkWeights(const LatticeMesh& mesh, const FusionOptions& options) {
  const std::vector<double>& weights = options.cost.fieldWeights;
  if (!weights.empty() && weights.size() != mesh.fields.size())
    return fail(ErrorCode::kBadInput, "there must be one field weight a field");
  const auto bad = [](double w) { return !(w >= 0) || std::isinf(w); };
  const auto badLabel = [&](const LabelCost& label) { return bad(label.weight); };
  if (std::ranges::any_of(weights, bad) || bad(options.cost.boundaryWeight.value_or(0)) ||
      std::ranges::any_of(options.cost.labels, badLabel) || bad(options.shapeWeight))
    return fail(ErrorCode::kBadInput, "weights must be finite and not negative");
  return {};
}

/// A field of regions or labels.
Status checkRegions(const LatticeMesh& mesh, std::size_t number) {
  if (number >= mesh.fields.size())
    return fail(ErrorCode::kBadInput, "there is no such field of regions");
  const FieldInfo& field = mesh.fields[number];
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
  const double ratio = options.targetRatio.value_or(kBaseRatio);
  if (options.targetRatio && options.baseCells)
    return fail(ErrorCode::kBadInput,
                "give a ratio or a number of cells for the base mesh, not both");
  if (!(ratio >= 0 && ratio <= 1))
    return fail(ErrorCode::kBadInput, "the target ratio must lie in 0..1");
  if (!(options.envelopeTolerance.value_or(0) >= 0))
    return fail(ErrorCode::kBadInput, "the envelope tolerance must not be negative");
  const auto isNone = [&](VertexId v) { return v >= mesh.points.size(); };
  if (std::ranges::any_of(options.kept, isNone))
    return fail(ErrorCode::kBadInput, "a vertex that is to be kept is none of the mesh");
  if (Status weights = checkWeights(mesh, options); !weights) return weights;
  for (const LabelCost& label : options.cost.labels)
    if (Status regions = checkRegions(mesh, label.field); !regions) return regions;
  return options.regionField ? checkRegions(mesh, *options.regionField) : Status{};
}

}  // namespace

std::size_t baseCellsOf(const FusionOptions& options, std::size_t cells) {
  if (options.baseCells) return *options.baseCells;
  const double of = static_cast<double>(cells);
  if (options.targetRatio) return static_cast<std::size_t>(*options.targetRatio * of);
  return std::min(static_cast<std::size_t>(kBaseRatio * of), kMaxBaseCells);
}

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
