#include "simplify/parts/parts_simplify.h"

#include <cassert>
#include <utility>

#include "proto/limits.h"
#include "simplify/fuse/fusion_loop.h"
#include "simplify/fuse/fusion_state.h"
#include "simplify/mesh/workers.h"
#include "simplify/parts/fusion_band.h"

namespace qtet {
namespace {

/// The share of vertices inside of parts that is enough.
constexpr double kEnoughInner = 0.87;
/// Bands end where fewer than so many times the wanted cells are left: the rest chooses among all
/// of them.
constexpr std::size_t kCellsOverTarget = 3;
/// A band that removes less than this fraction of the cells is the last.
constexpr double kWorthABand = 0.1;

class Bands {
 public:
  Bands(FusionState& state, const FusionFrame& frame, const FusionOptions& options,
        const PartsOptions& parts, Workers& workers)
      : state_(state), frame_(frame), options_(options), parts_(parts), workers_(workers) {}

  /// The number of levels.
  std::uint32_t run() {
    const std::size_t all = live(), target = baseCellsOf(options_, all);
    const auto isFarFrom = [&] { return live() >= kCellsOverTarget * target; };
    CutMesh cut;
    for (const std::size_t cells : parts_.cellsOfAPart) {
      if (all / cells < parts_.minParts || !isFarFrom()) break;
      assert(cells > 0);
      cells_ = cells;
      cut = cutAnew({});
      if (cut.innerShare >= kEnoughInner) break;
    }
    std::uint32_t levels = 0;
    for (bool isWorth = cells_ > 0; isWorth;) {
      const std::size_t before = live();
      levels = fuseBand(state_, frame_, options_, workers_, cut, target, levels);
      ++bands_;
      if (options_.progress) options_.progress(progressOf(all, live(), target));
      assert(live() <= before && levels <= kMaxLevels);
      isWorth = static_cast<double>(before - live()) >= kWorthABand * static_cast<double>(before) &&
                live() / cells_ >= parts_.minPartsLater && isFarFrom() && levels < kMaxLevels / 2;
      if (isWorth) cut = cutAnew(cut.isSeam);
    }
    return levels;
  }

  [[nodiscard]] std::uint32_t bands() const { return bands_; }

 private:
  [[nodiscard]] std::size_t live() const { return state_.mesh().liveTetrahedra(); }
  [[nodiscard]] CutMesh cutAnew(std::span<const std::uint8_t> old) {
    return cutMesh(state_.mesh(), parts_.partition, cells_, bands_, old, workers_);
  }

  FusionState& state_;
  const FusionFrame& frame_;
  const FusionOptions& options_;
  const PartsOptions& parts_;
  Workers& workers_;
  std::size_t cells_ = 0;  // of a part; 0: nothing is cut
  std::uint32_t bands_ = 0;
};

}  // namespace

Result<PartsFusion> simplifyInParts(LatticeMesh&& mesh, const FusionOptions& options,
                                    const PartsOptions& parts, const EarlierFusions* earlier) {
  PartsFusion out;
  const auto inBands = [&](FusionState& state, const FusionFrame& frame) {
    Workers workers(options.threads, options.stop);
    Bands bands(state, frame, options, parts, workers);
    const std::uint32_t levels = bands.run();
    out.bands = bands.bands();
    return levels;
  };
  Result<FusionHistory> history = simplify(std::move(mesh), options, inBands, earlier);
  if (!history) return std::unexpected(history.error());
  out.history = std::move(*history);
  return out;
}

}  // namespace qtet
