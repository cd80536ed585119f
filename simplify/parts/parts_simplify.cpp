#include "simplify/parts/parts_simplify.h"

#include <cmath>
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
/// Bands end where fewer than so many times the wanted cells are left: none must pass them.
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
    CutMesh cut;
    for (const std::size_t cells : parts_.cellsOfAPart) {
      if (all / cells < parts_.minParts) break;
      cells_ = cells;
      cut = cutAnew(0, {});
      if (cut.innerShare >= kEnoughInner) break;
    }
    std::uint32_t levels = 0;
    bool isWorth = cells_ > 0;
    for (std::uint32_t band = 1; isWorth && live() >= kCellsOverTarget * target; ++band) {
      const std::size_t before = live();
      levels = fuseBand(state_, frame_, options_, workers_, cut, levels);
      if (options_.progress) options_.progress(progressOf(all, live(), target));
      isWorth = static_cast<double>(before - live()) >= kWorthABand * static_cast<double>(before) &&
                live() / cells_ >= parts_.minPartsLater && levels < kMaxLevels / 2;
      if (isWorth) cut = cutAnew(band, cut.isSeam);
    }
    return levels;
  }

 private:
  [[nodiscard]] std::size_t live() const { return state_.mesh().liveTetrahedra(); }
  [[nodiscard]] CutMesh cutAnew(std::uint32_t band, std::span<const std::uint8_t> old) {
    return cutMesh(state_.mesh(), parts_.partition, cells_, band, old, workers_);
  }

  FusionState& state_;
  const FusionFrame& frame_;
  const FusionOptions& options_;
  const PartsOptions& parts_;
  Workers& workers_;
  std::size_t cells_ = 0;  // of a part; 0: nothing is cut
};

}  // namespace

Result<FusionHistory> simplifyInParts(LatticeMesh&& mesh, const FusionOptions& options,
                                      const PartsOptions& parts) {
  return simplify(std::move(mesh), options, [&](FusionState& state, const FusionFrame& frame) {
    Workers workers(options.threads, options.stop);
    return Bands(state, frame, options, parts, workers).run();
  });
}

}  // namespace qtet
