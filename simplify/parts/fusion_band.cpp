#include "simplify/parts/fusion_band.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <optional>
#include <utility>

#include "simplify/parts/band_price.h"

namespace qtet {
namespace {

/// That price is found in one part of so many, and in so many at least.
constexpr std::size_t kSampledOneIn = 8, kMinSampled = 10;
/// A level of the whole removes this share of its cells, or as many as a part's level that ends it.
constexpr double kLevelShare = 0.05;

/// The fusions of the parts with these numbers.
std::vector<PartFusions> fuseParts(const FusionState& whole, const FusionFrame& frame,
                                   const FusionOptions& options, Workers& workers,
                                   const CutMesh& cut, std::span<const std::size_t> chosen,
                                   const auto& endOf) {
  std::vector<PartFusions> out(chosen.size());
  std::vector<PartNumbers> numbers(workers.count());
  workers.forEach(chosen.size(), 1, [&](std::size_t worker, std::size_t i) {
    assert(chosen[i] < cut.parts.size() && worker < numbers.size());
    const std::vector<CellId>& cells = cut.parts[chosen[i]];
    numbers[worker].resize(whole.mesh().vertexSlots(), kGhost);
    out[i] =
        fusePart(whole, frame, options, cells, cut.isSeam, endOf(cells.size()), numbers[worker]);
  });
  return out;
}

std::vector<std::vector<PartLevel>> levelsOf(std::span<const PartFusions> parts) {
  std::vector<std::vector<PartLevel>> out;
  for (const PartFusions& part : parts) out.push_back(part.done.levels);
  return out;
}

/// This share of a part's cells, and no fewer.
std::size_t cellsOf(double share, std::size_t own) {
  return static_cast<std::size_t>(std::ceil(share * static_cast<double>(own)));
}

/// Some parts, and the price that they tell.
struct Sample {
  std::vector<std::size_t> chosen;
  std::vector<PartFusions> parts;
  float key = 0;  ///< where the band ends
};

Sample sampleOf(const FusionState& whole, const FusionFrame& frame, const FusionOptions& options,
                Workers& workers, const CutMesh& cut, double goal) {
  const double share = shareLeft(1 / kBandFactor, cut.innerShare);
  const std::size_t step =
      std::clamp<std::size_t>(cut.parts.size() / kMinSampled, 1, kSampledOneIn);
  Sample out;
  std::size_t cells = 0;
  for (std::size_t p = 0; p < cut.parts.size(); p += step)
    out.chosen.push_back(p), cells += cut.parts[p].size();
  out.parts = fuseParts(whole, frame, options, workers, cut, out.chosen, [&](std::size_t own) {
    return PartEnd{.cells = cellsOf(std::max(kSampledTo * share, goal), own)};
  });
  out.key = keyAt(levelsOf(out.parts), cells, share);
  return out;
}

/// Drops the levels of the part from the first one on that ends beyond the key. False: it was cut
/// before.
bool endAt(float key, PartLevels& part) {
  const auto dear =
      std::ranges::find_if(part.levels, [&](const PartLevel& level) { return level.key > key; });
  if (dear == part.levels.end() && part.isCut) return false;
  part.levels.erase(dear, part.levels.end());
  return true;
}

/// The fusions of all parts, up to the key of a sample of them.
std::vector<PartFusions> fuseAll(const FusionState& whole, const FusionFrame& frame,
                                 const FusionOptions& options, Workers& workers, const CutMesh& cut,
                                 std::size_t target) {
  const double goal = static_cast<double>(target) /
                      static_cast<double>(std::max<std::size_t>(whole.mesh().liveTetrahedra(), 1));
  Sample sample = sampleOf(whole, frame, options, workers, cut, goal);
  std::vector<PartFusions> out(cut.parts.size());
  std::vector<std::uint8_t> isDone(cut.parts.size(), 0);
  for (std::size_t i = 0; i < sample.chosen.size(); ++i) {
    isDone[sample.chosen[i]] = endAt(sample.key, sample.parts[i].done);
    if (isDone[sample.chosen[i]]) out[sample.chosen[i]] = std::move(sample.parts[i]);
  }
  std::vector<std::size_t> others;
  for (std::size_t p = 0; p < cut.parts.size(); ++p)
    if (!isDone[p]) others.push_back(p);
  std::vector<PartFusions> rest = fuseParts(
      whole, frame, options, workers, cut, others,
      [&](std::size_t own) { return PartEnd{.key = sample.key, .cells = cellsOf(goal, own)}; });
  for (std::size_t i = 0; i < others.size(); ++i) out[others[i]] = std::move(rest[i]);
  return out;
}

/// Does to the whole what parts did, level by level. Parts do not know of each other's boundary.
/// Where a fusion that goes outside would meet it, its part ends.
class Replay {
 public:
  Replay(FusionState& whole, const FusionFrame& frame, std::span<const PartFusions> parts)
      : whole_(whole), parts_(parts) {
    for (const PartFusions& part : parts) vertices_.push_back(part.vertices);
    done_.resize(parts.size());
    if (frame.allowed) boundary_.emplace(whole.mesh());
  }

  void beginLevel() {
    if (boundary_) boundary_->beginLevel();
  }

  /// The part's next level. The number of its fusions that were done.
  std::size_t fuse(std::size_t part, const PartLevel& own, std::uint32_t level) {
    std::size_t count = 0;
    while (count < own.fusions && fuse(part, level)) ++count;
    return count;
  }

 private:
  /// False: it would meet the boundary.
  bool fuse(std::size_t part, std::uint32_t level) {
    const PartFusions& own = parts_[part];
    assert(done_[part] < own.history.fusions.size());
    assert(own.done.wentOutside.size() == own.history.fusions.size());
    const FusionHistory& h = own.history;
    const Fusion& fusion = h.fusions[done_[part]];
    std::vector<VertexId>& vertices = vertices_[part];
    Prey& prey = proposal_.prey;
    Star& star = proposal_.star;
    prey = {fusion.k, {}};
    for (std::size_t i = 0; i < fusion.k; ++i) prey.vertex[i] = vertices[fusion.prey[i]];
    star.affected.clear(), star.deleted.clear();
    for (std::size_t i = 0; i < fusion.affectedCount; ++i)
      star.affected.push_back(own.cells[h.affectedCells[fusion.firstAffected + i]]);
    for (std::size_t i = 0; i < fusion.deletedCount; ++i)
      star.deleted.push_back(own.cells[h.deletedCells[fusion.firstDeleted + i]]);
    const auto labels =
        h.affectedLabels.begin() + static_cast<std::ptrdiff_t>(fusion.firstAffected);
    star.labels.assign(labels, labels + fusion.affectedCount);
    values_.clear();
    for (std::size_t f = 0; f < h.fields.size(); ++f) {
      if (isCellField(h.fields[f])) continue;
      const std::size_t n = h.fields[f].components;
      const auto first = h.values[f].begin() + static_cast<std::ptrdiff_t>(fusion.fused * n);
      values_.insert(values_.end(), first, first + static_cast<std::ptrdiff_t>(n));
    }
    proposal_.where.point = h.points[fusion.fused];
    const auto fused = static_cast<VertexId>(whole_.mesh().vertexSlots());
    if (boundary_) {
      if (own.done.wentOutside[done_[part]] && boundary_->isMetBy(proposal_)) return false;
      boundary_->decideOn(proposal_, fused);
    }
    assert(fusion.fused == vertices.size());
    vertices.push_back(fused);
    ++done_[part];
    whole_.fuse(prey, {proposal_.where.point, values_}, star, level);
    return true;
  }

  FusionState& whole_;
  std::span<const PartFusions> parts_;
  std::vector<std::vector<VertexId>> vertices_;  // of the whole, by part and its own number
  std::vector<std::size_t> done_;                // fusions, by part
  std::optional<LiveBoundary> boundary_;
  Proposal proposal_;
  std::vector<std::int32_t> values_;
};

}  // namespace

std::vector<std::vector<std::uint32_t>> levelsOfTheWhole(
    std::span<const std::vector<PartLevel>> parts, std::size_t cells) {
  std::vector<std::vector<std::uint32_t>> out(parts.size());
  std::uint32_t now = 0;
  std::size_t removed = 0;  // in level `now`
  for (const LevelOfPart& level : levelsInOrder(parts)) {
    if (static_cast<double>(removed) >= kLevelShare * static_cast<double>(cells)) {
      ++now;
      assert(removed <= cells);
      cells -= removed;
      removed = 0;
    }
    assert(out[level.part].size() == level.level);
    std::vector<std::uint32_t>& own = out[level.part];
    own.push_back(own.empty() ? now : std::max(now, own.back() + 1));
    removed += level.removed;
  }
  return out;
}

std::uint32_t fuseBand(FusionState& whole, const FusionFrame& frame, const FusionOptions& options,
                       Workers& workers, const CutMesh& cut, std::size_t target,
                       std::uint32_t levels) {
  const std::vector<PartFusions> done = fuseAll(whole, frame, options, workers, cut, target);
  assert(done.size() == cut.parts.size());
  const std::vector<std::vector<PartLevel>> ofParts = levelsOf(done);
  const auto numbers = levelsOfTheWhole(ofParts, whole.mesh().liveTetrahedra());
  Replay replay(whole, frame, done);
  std::vector<std::size_t> next(done.size(), 0);
  std::size_t open = done.size();  // parts with levels to come
  for (std::uint32_t number = 0; open > 0; ++number) {
    open = 0;
    std::size_t count = 0;
    replay.beginLevel();
    for (std::size_t p = 0; p < done.size(); ++p) {
      if (next[p] < numbers[p].size() && numbers[p][next[p]] == number) {
        const PartLevel& own = ofParts[p][next[p]++];
        const std::size_t fused = replay.fuse(p, own, levels);
        count += fused;
        if (fused < own.fusions) next[p] = numbers[p].size();
      }
      open += next[p] < numbers[p].size();
    }
    levels += count > 0;
    workers.throwIfStopped();
  }
  return levels;
}

}  // namespace qtet
