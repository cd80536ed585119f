// Checks a solid of tetrahedra by the definitions: validity, topology, singularities, embedding and
// containment. Exact, and independent of the simplifier: they share only the mesh's types.
// Near-linear time; for meshes of up to some ten thousand cells.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "codec/mesh/mesh.h"

namespace qtet::testing {

struct SolidReport {
  std::uint64_t notPositive = 0;   ///< cells of zero or negative volume
  std::uint64_t facesOfThree = 0;  ///< faces of more than two cells
  /// Faces whose two cells run through them in the same rotation.
  std::uint64_t facesOneSided = 0;
  bool boundaryAgrees = true;  ///< mesh.boundary is the faces of one cell, outward
  std::uint64_t overlaps = 0;  ///< pairs of cells whose insides meet
  /// Pairs of boundary triangles that meet elsewhere than in the vertices they share.
  std::uint64_t crossings = 0;
  std::int64_t faceComponents = 0;      ///< sets of cells that hang together by faces
  std::array<std::int64_t, 4> betti{};  ///< over Z/2: components, tunnels, cavities, 0
  /// Euler characteristic of each connected part of the boundary, ascending.
  std::vector<std::int64_t> boundaryEuler;
  /// Boundary vertices whose triangles are not one closed fan; ascending.
  std::vector<LatticePoint> singularVertices;
  /// Boundary edges of more than two triangles; ascending.
  std::vector<std::array<LatticePoint, 2>> singularEdges;
  std::int64_t volume6 = 0;  ///< six times the cells' volume

  /// Empty for an embedded solid, else what is wrong with it.
  [[nodiscard]] std::string faults() const;
};

/// REQUIRES: ids in range, four different vertices a cell, coordinates below 2^20 and different
/// from vertex to vertex.
[[nodiscard]] SolidReport checkSolid(const LatticeMesh& mesh);

/// Empty if both have the same topology, to the singular vertices and edges in their very places;
/// else the first difference.
[[nodiscard]] std::string topologyChange(const SolidReport& now, const SolidReport& original);

/// Empty if the solid `inner` is a subset of the solid `outer`, at tolerance 0; else the first cell
/// that is not. Exact: a cell whose inside no boundary triangle of `outer` meets lies on one side
/// of that boundary, on that of its barycentre. REQUIRES: both without faults, on the same lattice.
[[nodiscard]] std::string whatIsOutside(const LatticeMesh& inner, const LatticeMesh& outer);

}  // namespace qtet::testing
