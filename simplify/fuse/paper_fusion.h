// The paper's own loop (Chopra & Meyer, section 3.5), to compare with its Table 1: tetrahedra only,
// planar quadric error, one strictly greedy queue (PAPER.md).
#pragma once

#include <cstdint>

#include "codec/mesh/mesh.h"
#include "codec/record/fusion_history.h"
#include "proto/error.h"
#include "simplify/fuse/qtetfusion.h"

namespace qtet {

/// Section 3.2 a: the least that the fusion of an interior tetrahedron removes. It removes the
/// prey, its four face neighbours and the other cells of each of the six edges. That is 5 + the sum
/// of (cells round the edge - 3), at least 11 if every edge has more than three cells. The paper
/// takes that for granted. Where it does not hold (thirteen cells can do it) the tetrahedron is not
/// fused.
inline constexpr std::size_t kMinOfInterior = 11;

/// The figures of a run that the paper's Table 1 states, and why the other tetrahedra stayed.
struct PaperFigures {
  std::uint64_t fusions = 0, removed = 0;  ///< removed: tetrahedra, Table 1(b)'s n_decim
  /// Those of `fusions` with no prey vertex on the boundary.
  std::uint64_t interiorFusions = 0;
  /// Wall time of the quadrics and the heap, Table 1(a)'s initHeap.
  double initialiseSeconds = 0;
  double fuseSeconds = 0;  ///< wall time of the loop
  /// Tetrahedra that were extracted and not fused, by the first rule that failed.
  struct Refused {
    std::uint64_t flip = 0;      ///< 3.2 b
    std::uint64_t envelope = 0;  ///< 3.2 c
    /// 3.2 d; singular vertices, too large stars and what the log cannot describe among them.
    std::uint64_t topology = 0;
    /// 3.2 a: an interior one that would remove fewer than kMinOfInterior.
    std::uint64_t few = 0;
  } refused;
};

struct PaperFusion {
  FusionHistory history;
  PaperFigures figures;
};

/// Only the options targetRatio, baseCells, progress and stop count: no field is in the cost, and
/// one thread does it all. REQUIRES: `mesh` cleaned and quantised. Errors: as simplify().
[[nodiscard]] Result<PaperFusion> simplifyAsThePaper(const LatticeMesh& mesh,
                                                     const FusionOptions& options);

}  // namespace qtet
