// By how much fields and boundary differ from linear between one cell and the next. It predicts
// what each is likely to lose when cells are fused (ALGORITHM.md, "The boundary weight").
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "codec/mesh/mesh.h"
#include "simplify/cost/cost_parts.h"

namespace qtet {

/// One a part: the mean square error of a cell's linear field at the far corner of the cell beyond
/// a face. The mean is over all faces by volume. It is in the cost's unit (CostPart::scale), all
/// components together. The error of rounding the field to integers is subtracted, which may leave
/// less than 0. In a large mesh some faces stand for all. Their places decide which, so neither
/// numbering nor order matters. REQUIRES: `parts` of point fields of `mesh`.
[[nodiscard]] std::vector<double> expectedFieldErrors(const LatticeMesh& mesh,
                                                      std::span<const CostPart> parts);

/// One face in so many stands for all, in a mesh of so many cells.
[[nodiscard]] std::uint64_t faceStep(std::uint64_t cells);
/// Whether the face is one of those.
[[nodiscard]] bool isSampledFace(const LatticeMesh& mesh, const Triangle& face, std::uint64_t step);
/// The same of a larger mesh, of which `mesh` has all cells with a face that isSampledFace, and
/// the vertices in their order. `step` is the larger one's.
[[nodiscard]] std::vector<double> expectedFieldErrors(const LatticeMesh& mesh,
                                                      std::span<const CostPart> parts,
                                                      std::uint64_t step);

/// The mean square of the distance between a boundary triangle's plane and the far corner of the
/// triangle beyond each edge. The mean is over the area, the distance in lattice steps. Creases do
/// not count: fusions keep them, or pay for them alone.
[[nodiscard]] double expectedBoundaryError(const LatticeMesh& mesh);

/// One edge in so many stands for all, on a boundary of so many triangles that comes in pieces.
[[nodiscard]] std::uint64_t edgeStep(std::uint64_t triangles);
[[nodiscard]] bool isSampledEdge(const LatticeMesh& mesh, VertexId a, VertexId b,
                                 std::uint64_t step);
/// As the other expectedFieldErrors, with the triangles of a sampled edge.
[[nodiscard]] double expectedBoundaryError(const LatticeMesh& mesh, std::uint64_t step);

}  // namespace qtet
