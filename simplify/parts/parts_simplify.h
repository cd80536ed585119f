// QTetFusion of a large mesh in parts, on all cores (PARTS.md). It comes in bands, each of which
// cuts what is left again. Then the rest is one piece.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "simplify/fuse/qtetfusion.h"
#include "simplify/parts/cell_graph.h"

namespace qtet {

struct PartsOptions {
  Partitioner partition{};
  /// Cells of a part: the least of these that leaves enough vertices inside of parts. Smaller parts
  /// have more seams, whose vertices wait for the next band.
  std::array<std::size_t, 3> cellsOfAPart{16'000, 32'000, 64'000};
  /// A mesh of fewer parts than this is not cut, and later what is left.
  std::size_t minParts = 64, minPartsLater = 8;
};

/// Parts of some `cells` cells, down to two of them: what a small mesh is cut into.
[[nodiscard]] inline PartsOptions smallParts(Partitioner partition, std::size_t cells) {
  return {.partition = std::move(partition),
          .cellsOfAPart = {cells, cells, cells},
          .minParts = 2,
          .minPartsLater = 2};
}

struct PartsFusion {
  FusionHistory history;
  std::uint32_t bands = 0;  ///< 0: nothing was cut
};

/// As simplify. A mesh that is too small to be cut has the same fusions as there. The result
/// depends on the parts, and on no number of threads.
[[nodiscard]] Result<PartsFusion> simplifyInParts(LatticeMesh&& mesh, const FusionOptions& options,
                                                  const PartsOptions& parts,
                                                  const EarlierFusions* earlier = nullptr);

}  // namespace qtet
