// A few elements of a mesh that comes in pieces, as a mesh of their own.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "codec/mesh/mesh.h"
#include "simplify/blocks/mesh_piece.h"

namespace qtet {

/// Collects cells (or triangles, or single vertices) with the points and point values of their
/// vertices.
class SampledPart {
 public:
  explicit SampledPart(std::vector<FieldInfo> fields) : fields_(std::move(fields)) {}

  /// `names` are the vertices of `piece`.
  void addCell(const LatticeMesh& piece, std::span<const WholeVertex> names,
               const Tetrahedron& cell);
  void addTriangle(const LatticeMesh& piece, std::span<const WholeVertex> names,
                   const Triangle& triangle);
  void addVertex(const LatticeMesh& piece, std::span<const WholeVertex> names, VertexId v);

  /// The vertices are in the order of their numbers, cells and triangles in that of adding.
  [[nodiscard]] LatticeMesh take(const Lattice& lattice);

 private:
  std::vector<FieldInfo> fields_;
  std::vector<WholeVertex> vertices_;  // as they came, some more than once
  LatticeMesh mesh_;                   // their points and values; cells name them
};

}  // namespace qtet
