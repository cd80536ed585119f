// Making a mesh from a file fit for simplifying (INPUT.md, "Cleaning"): what can be repaired
// without guessing is, what cannot is refused.
#pragma once

#include <array>
#include <cstdint>
#include <expected>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

#include "proto/error.h"
#include "simplify/mesh/tet_mesh.h"

namespace qtet {

/// How many of one kind, and which first, in the numbering before cleaning.
struct Occurrences {
  static constexpr std::size_t kShown = 8;

  std::uint64_t count = 0;
  std::vector<std::uint64_t> first;

  void add(std::uint64_t index) {
    if (count++ < kShown) first.push_back(index);
  }
};

struct CleanReport {
  Occurrences repeatedVertexCells;  ///< cells that name a vertex twice: dropped
  Occurrences duplicateCells;       ///< cells with the four vertices of an earlier one: dropped
  Occurrences flatCells;            ///< cells of exactly zero volume: kept
  Occurrences reorientedCells;      ///< cells whose vertices were put in another order
  Occurrences invertedCells;        ///< cells inside out against their neighbours: kept
  Occurrences unusedPoints;         ///< points of no cell: dropped
  Occurrences coincidentPoints;     ///< points at the place of an earlier one: kept apart
  /// Boundary edges of more than two boundary triangles: kept; `first` holds the lower vertex,.
  Occurrences nonManifoldEdges;
  std::vector<std::uint64_t> nonManifoldEdgeEnds;  ///< and this the upper one
  /// Boundary vertices whose triangles are not one closed fan: kept.
  Occurrences nonManifoldVertices;
  std::uint64_t components = 0;    ///< sets of cells that hang together by faces
  double volume = 0;               ///< of the cleaned mesh; inverted cells count negative
  std::array<Position, 2> box{};   ///< the cleaned mesh's lowest and highest coordinates
  std::vector<Triangle> boundary;  ///< the cleaned mesh's, as boundaryOf gives it

  /// Changes made and unusual findings, one sentence each; empty for a flawless mesh.
  [[nodiscard]] std::vector<std::string> sentences() const;
};

/// Refuses a face of these cells, more than two, by their numbers in the input.
[[nodiscard]] std::unexpected<Error> overlap(std::span<const std::uint64_t> cells);
/// Refuses two neighbours whose component cannot be oriented.
[[nodiscard]] std::unexpected<Error> ringWithoutInside(std::uint64_t cell, std::uint64_t other);

/// Cleans in place: drops cells and points with their field values, orders each cell's vertices;
/// what remains keeps its order. Errors: bad-input (no cell remains; a face of more than two cells;
/// a component that cannot be oriented), cells named as numbered before; cancelled (the mesh is
/// unspecified then). REQUIRES: vertex ids below the number of points, finite coordinates.
[[nodiscard]] Result<CleanReport> cleanMesh(TetMesh& mesh, const std::stop_token& stop = {});

}  // namespace qtet
