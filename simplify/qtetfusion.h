// QTetFusion (Chopra & Meyer, sections 3.2-3.5): fuses tetrahedra, triangles and edges into points in order of what it costs, in levels of
// independent fusions, and keeps what undoes each of them (ALGORITHM.md).
#pragma once

#include <functional>
#include <optional>

#include "codec/fusion_history.h"
#include "codec/mesh.h"
#include "proto/error.h"
#include "simplify/fusion_cost.h"
#include "simplify/fusion_point.h"

namespace qtet {

/// ALGORITHM.md, "Bands".
struct BandOptions {
  std::size_t cellsPerPacket = 0;  ///< of the input, a leaf of the tree that bands keep to; 0: no bands
  std::size_t most = 6;            ///< with each more, small boxes take fewer bytes and coarse levels get worse
  /// A band ends at the key that this fraction of the vertices' best edges does not pass at its start. 0.9 to 1 trades the error of coarse levels for
  /// the bytes of a box (tests/bench/REGIONS.md).
  double dearest = 0.93;
  double levelQuantile = 0.5;  ///< a level of a band ends at this quantile of what the band can afford, 0..1
};

struct FusionOptions {
  double targetRatio = 0.01;                         ///< stop when this fraction of the cells remains, 0..1
  CostOptions cost;
  double envelopeTolerance = 0;                      ///< how far the boundary may leave the original solid, over the diagonal of its bounding box, >= 0
  std::optional<std::size_t> regionField;            ///< the cell field of one component whose values are regions that keep their topology
  double shapeWeight = 0.5;                          ///< what badly shaped new cells add to the cost, >= 0 (ALGORITHM.md, "Shape")
  PlacementRule placement = PlacementRule::kAuto;
  BandOptions bands;
  int threads = 1;                                   ///< the result never depends on it
  std::function<void(double fraction)> progress;     ///< 0..1, called at most once a level
};

/// REQUIRES: `mesh` cleaned and quantised (clean_mesh.h, quantise.h). Vertices that no cell uses stay out of the history.
/// Errors: bad-input (no tetrahedra, a ratio outside 0..1, weights that are negative or not one a field), limit-exceeded (too many levels).
[[nodiscard]] Result<FusionHistory> simplify(const LatticeMesh& mesh, const FusionOptions& options);
/// The same for a mesh that is not needed any more: its memory is given back before the first fusion.
[[nodiscard]] Result<FusionHistory> simplify(LatticeMesh&& mesh, const FusionOptions& options);

}  // namespace qtet
