#include "simplify/fuse/fusion_loop.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <deque>
#include <utility>

#include "proto/limits.h"
#include "simplify/mesh/moved_place.h"

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
constexpr double kTurnCosine = 0.3;

}  // namespace

FusionFrame::FusionFrame(const LatticeMesh& mesh, const FusionState& whole,
                         const FusionOptions& options, CellId firstSeam)
    : displacements(sampledDisplacements(mesh, options.checkedInstants)) {
  assert(whole.mesh().fusions() == 0 && whole.mesh().firstGhost() == mesh.tetrahedra.size());
  const double tolerance = options.envelopeTolerance.value_or(kEnvelopeTolerance);
  if (tolerance > 0)
    allowed = std::make_unique<AllowedSpace>(whole.mesh(),
                                             tolerance * whole.cost().frame().diagonal, firstSeam);
}

double progressOf(std::size_t cells, std::size_t live, std::size_t target) {
  assert(live <= cells);
  if (cells <= target || target == 0) return 1;
  const auto over = [&](std::size_t n) {
    return std::log(static_cast<double>(cells) / static_cast<double>(n));
  };
  return over(std::max(live, target)) / over(target);
}

FusionLoop::FusionLoop(FusionState& state, const FusionFrame& frame, const FusionOptions& options,
                       Workers& workers, std::uint32_t levels)
    : options_(options), frame_(frame), state_(state), workers_(workers), levels_(levels) {
  assert(levels <= kMaxLevels);
  limitBy(kShapeFloor, kTurnCosine);
}

Result<std::uint32_t> FusionLoop::run(std::size_t target) {
  target_ = target;
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
  return levels_;
}

PartLevels FusionLoop::runPart(const PartEnd& end, const PartSurroundings& beside) {
  PartLevels out;
  assert(end.leastShare >= 0);
  target_ = end.cells;
  fusions_.keepOff(beside);
  open_.findAll();
  for (std::size_t before = live(); levels_ < kMaxLevels && runLevel(end.key); before = live()) {
    if (fusions_.fused().empty()) break;
    assert(live() < before);
    out.levels.push_back({queue_.limit(), fusions_.fused().size(), before - live()});
    out.isCut = live() <= target_;
    if (out.isCut || !isWorth(end.leastShare, before)) break;
  }
  out.wentOutside = std::move(fusions_.wentOutside());
  return out;
}

/// From all candidates to the target, or until nothing is left to try. False: it stalls, and
/// starting from all candidates again would not help.
bool FusionLoop::runLevels() {
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

/// False when nothing is left to try, or the level would end beyond that key.
bool FusionLoop::runLevel(float lastKey) {
  assert(levels_ < kMaxLevels);
  open_.fill(queue_.refill());
  if (queue_.entries().empty()) return false;
  queue_.begin(kLevelQuantile);
  if (queue_.limit() > lastKey) return false;
  fusions_.begin(levels_);
  decider_.run(queue_, fusions_, target_);
  if (!fusions_.fused().empty()) ++levels_;
  open_.add(fusions_);
  if (options_.progress) options_.progress(progressOf(state_.mesh().firstGhost(), live(), target_));
  return true;
}

/// Whether at least this fraction of the cells that were there before is gone.
bool FusionLoop::isWorth(double fraction, std::size_t before) const {
  assert(live() <= before && fraction >= 0);
  return static_cast<double>(before - live()) >= fraction * static_cast<double>(before);
}

/// Limits fusions by the worst shape of a cell, and the cosine of the largest turn of a boundary
/// triangle.
void FusionLoop::limitBy(double shapeFloor, double normalCosine) {
  assert(shapeFloor >= 0 && normalCosine >= -1 && normalCosine <= 1);
  const FusionLimits limits{shapeFloor, frame_.allowed.get(), normalCosine, frame_.displacements};
  proposers_.clear();
  for (std::size_t i = 0; i < workers_.count(); ++i)
    proposers_.push_back(std::make_unique<FusionProposer>(
        state_.mesh(), state_.cost(), state_.changes(), limits,
        FusionPointOptions{options_.placement, options_.shapeWeight, frame_.displacements}));
}

}  // namespace qtet
