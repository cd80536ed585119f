// QTetFusion (Chopra & Meyer, sections 3.2-3.5) fuses tetrahedra, triangles and edges into points,
// in order of cost, in levels of independent fusions. It keeps what undoes each of them
// (ALGORITHM.md).
#pragma once

#include <functional>
#include <optional>
#include <stop_token>
#include <vector>

#include "codec/mesh/mesh.h"
#include "codec/record/fusion_history.h"
#include "proto/error.h"
#include "simplify/cost/cost_frame.h"
#include "simplify/cost/cost_options.h"
#include "simplify/fuse/placement_rule.h"

namespace qtet {

class FusionState;
struct FusionFrame;

/// Cells of the base mesh where nothing else is asked for: this fraction, but no more than so many.
/// A viewer has these within the first hundred kilobytes.
inline constexpr double kBaseRatio = 0.01;
inline constexpr std::size_t kMaxBaseCells = 30'000;

/// FusionOptions::envelopeTolerance where nothing else is asked for. Thin parts keep their volume
/// then, and logs are smaller at equal errors (ALGORITHM.md, "The envelope's tolerance").
inline constexpr double kEnvelopeTolerance = 0.005;

/// FusionOptions::checkedInstants where nothing else is asked for.
inline constexpr std::size_t kCheckedInstants = 8;

struct FusionOptions {
  /// Stop when this fraction of the cells remains, 0..1.
  std::optional<double> targetRatio{};
  /// Stop when so many cells remain. Not beside targetRatio.
  std::optional<std::size_t> baseCells{};
  CostOptions cost;
  /// How far the solid may leave the original one, over the diagonal of its bounding box, >= 0.
  std::optional<double> envelopeTolerance{};
  /// The cell field of one component whose values are regions that keep their topology. Their
  /// interfaces count if cost.labels has it.
  std::optional<std::size_t> regionField;
  /// The weight of badly shaped new cells in the cost, >= 0 (ALGORITHM.md, "Shape").
  double shapeWeight = 0.5;
  PlacementRule placement = PlacementRule::kAuto;
  /// Instants of a field Displacement at which no cell may flip, at most (moved_place.h).
  std::size_t checkedInstants = kCheckedInstants;
  /// Vertices that no fusion takes, such as those that the patches of a mesh share.
  std::vector<VertexId> kept{};
  int threads = 1;                                ///< the result never depends on it
  std::function<void(double fraction)> progress;  ///< 0..1, called at most once a level
  std::stop_token stop{};                         ///< asked many times a second
};

/// How many of `cells` are to remain; more do where no fusion is left.
[[nodiscard]] std::size_t baseCellsOf(const FusionOptions& options, std::size_t cells);

/// REQUIRES: `mesh` cleaned and quantised (clean_mesh.h, quantise.h). Vertices that no cell uses
/// stay out of the history. Errors: bad-input (no tetrahedra, a ratio outside 0..1, or beside a
/// number of cells; weights that are negative or not one a field; a kept vertex that is none),
/// limit-exceeded (too many levels), cancelled.
[[nodiscard]] Result<FusionHistory> simplify(const LatticeMesh& mesh, const FusionOptions& options);
/// Does fusions before all others; the number of levels then.
using FirstFusions = std::function<std::uint32_t(FusionState& state, const FusionFrame& frame)>;

/// The fusions that a mesh has behind it, as its vertices have them (reduce_mesh.h).
struct EarlierFusions {
  CostFrame cost;
  std::vector<double> quadrics;  ///< FusionCost::quadric of each vertex
};

/// The same for a mesh that is not needed any more: its memory is given back before the first
/// fusion. `earlier`: null where there was none.
[[nodiscard]] Result<FusionHistory> simplify(LatticeMesh&& mesh, const FusionOptions& options,
                                             const FirstFusions& first = {},
                                             const EarlierFusions* earlier = nullptr);

}  // namespace qtet
