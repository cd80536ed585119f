// The levels of fusions of a mesh, or of a part of one: what is decided on, and until when
// (ALGORITHM.md, "Levels").
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "simplify/fuse/fusion_proposer.h"
#include "simplify/fuse/fusion_state.h"
#include "simplify/fuse/level_decider.h"
#include "simplify/fuse/level_fusions.h"
#include "simplify/fuse/level_queue.h"
#include "simplify/fuse/live_boundary.h"
#include "simplify/fuse/open_vertices.h"
#include "simplify/fuse/qtetfusion.h"
#include "simplify/legality/allowed_space.h"
#include "simplify/mesh/workers.h"

namespace qtet {

/// All that is of the whole mesh beside the cost's frame, made once. So a part's fusions are judged
/// as those of the whole.
struct FusionFrame {
  /// REQUIRES: `whole` is that of `mesh` before the first fusion. Ghosts from `firstSeam` on are
  /// seams of a block.
  FusionFrame(const LatticeMesh& mesh, const FusionState& whole, const FusionOptions& options,
              CellId firstSeam = OriginalSurface::kNoSeam);

  /// Where fusions may go outside; null where none may.
  std::unique_ptr<const AllowedSpace> allowed;
  std::vector<std::size_t> displacements;  ///< FusionOptions::checkedInstants
};

/// Where the fusions of a part end.
struct PartEnd {
  /// No level ends at a dearer key.
  float key = std::numeric_limits<float>::infinity();
  std::size_t cells = 0;  ///< so many tetrahedra are left
  /// Or behind a level that removes less than this fraction of the tetrahedra: flags say of each
  /// vertex in each level whether it splits.
  double leastShare = 0.01;
};

/// A level of a part.
struct PartLevel {
  float key = 0;  ///< where it ended
  std::size_t fusions = 0;
  std::size_t removed = 0;  ///< tetrahedra
};

/// The levels of a part. `isCut`: so many tetrahedra were left within the last one, which may go
/// on.
struct PartLevels {
  std::vector<PartLevel> levels;
  std::vector<std::uint8_t> wentOutside;  ///< LevelFusions::wentOutside
  bool isCut = false;
};

/// How far simplifying is, 0..1. Removal is geometric, so it is the logarithm of what is left.
[[nodiscard]] double progressOf(std::size_t cells, std::size_t live, std::size_t target);

class FusionLoop {
 public:
  /// The first level's number is `levels`. REQUIRES: all outlive this.
  FusionLoop(FusionState& state, const FusionFrame& frame, const FusionOptions& options,
             Workers& workers, std::uint32_t levels = 0);

  /// Until `target` tetrahedra are left, or no fusion is. The levels' number. Errors:
  /// limit-exceeded (too many levels), cancelled.
  [[nodiscard]] Result<std::uint32_t> run(std::size_t target);
  /// A part of a mesh. `beside` outlives this.
  [[nodiscard]] PartLevels runPart(const PartEnd& end, const PartSurroundings& beside);

 private:
  bool runLevels();
  bool runLevel(float lastKey = std::numeric_limits<float>::infinity());
  [[nodiscard]] std::size_t live() const { return state_.mesh().liveTetrahedra(); }
  [[nodiscard]] bool isWorth(double fraction, std::size_t before) const;
  void limitBy(double shapeFloor, double normalCosine);

  const FusionOptions& options_;
  const FusionFrame& frame_;
  FusionState& state_;
  Workers& workers_;
  std::size_t target_ = 0;  // so many tetrahedra are to be left
  std::unique_ptr<LiveBoundary> boundary_ =
      frame_.allowed ? std::make_unique<LiveBoundary>(state_.mesh()) : nullptr;
  Proposers proposers_;  // one a worker
  OpenVertices open_{state_, workers_, proposers_};
  LevelQueue queue_;
  LevelFusions fusions_{state_, boundary_.get()};
  LevelDecider decider_{state_, workers_, proposers_};
  std::uint32_t levels_;
};

}  // namespace qtet
