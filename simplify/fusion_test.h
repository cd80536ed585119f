// Whether a fusion keeps the mesh what it is: topology exactly (the link test with the ghost vertex), no cell flipped, inside the boundary
// envelope (ALGORITHM.md, "Legality"). All decisions on lattice integers, except the shape guard.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "codec/deleted_cells.h"
#include "codec/link.h"
#include "simplify/fusion_mesh.h"

namespace qtet {

class FusionTest {
 public:
  explicit FusionTest(const FusionMesh& mesh) : mesh_(mesh) {}

  /// Collects the star of the prey. False when it is too large or already rules the fusion out.
  [[nodiscard]] bool gather(const Prey& prey);
  /// Keeps topology: of the solid, of its boundary, and of every component of either; and the log can describe it. REQUIRES gather.
  [[nodiscard]] bool keepsTopology();
  /// No affected cell flips or is squashed. REQUIRES gather.
  [[nodiscard]] bool keepsCells(const LatticePoint& p) const;
  /// p lies on the inner side of (or on) every boundary face of the star. REQUIRES gather.
  [[nodiscard]] bool insideEnvelope(const LatticePoint& p) const;
  /// Moves p onto the planes of the boundary faces that it lies outside of, one after the other, until its lattice point is inside.
  [[nodiscard]] bool projectInside(Vector3 p, LatticePoint& inside) const;

  [[nodiscard]] std::span<const CellId> affected() const { return affected_; }
  [[nodiscard]] std::span<const std::uint8_t> labels() const { return labels_; }
  [[nodiscard]] std::span<const CellId> deleted() const { return deleted_; }
  /// The star's vertices that are not prey, kGhost among them where the prey touches the boundary.
  [[nodiscard]] std::span<const VertexId> linkVertices() const { return others_; }

 private:
  [[nodiscard]] int preyIndex(VertexId v) const;
  [[nodiscard]] bool deletedOnLink() const;
  [[nodiscard]] bool patchIsDisc() const;
  [[nodiscard]] bool describable();
  void measureShape();

  const FusionMesh& mesh_;
  Prey prey_;
  std::vector<CellId> affected_, deleted_;
  std::vector<std::uint8_t> labels_;
  std::vector<std::array<VertexId, 4>> turned_;  // affected cells, prey vertex last
  std::vector<Triangle> boundaryFaces_;          // of the star, counter-clockwise from outside
  std::vector<VertexId> others_;
  Link link_;
  double shapeFloor_ = 0;                        // new cells must be at least as well shaped
  std::vector<std::uint32_t> cellStamp_, vertexStamp_;
  std::uint32_t stamp_ = 0;
  DeletedModels models_;
  std::vector<LocalCell> truth_, derived_;
};

}  // namespace qtet
