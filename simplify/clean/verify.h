// Proof that what was decoded is what was put in: two meshes compared cell for cell, whatever the
// numbering.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "codec/mesh/mesh.h"
#include "proto/error.h"
#include "simplify/mesh/tet_mesh.h"

namespace qtet {

struct VerifyReport {
  std::uint64_t vertices = 0;
  std::uint64_t tetrahedra = 0;
  /// Vertices that neither position, fields nor neighbours tell from another one: exchanging them
  /// changes nothing that a file shows.
  std::uint64_t interchangeable = 0;
};

/// Whether the meshes are equal up to the numbering of vertices and cells and up to even
/// permutations within a cell. Compares lattice points and field integers of every vertex, and
/// every cell with its orientation and field integers. Vertices are matched by 128-bit hashes of
/// their data, refined over the cells round them. So neighbourhoods tell coincident points with
/// equal values apart. A wrong mesh passes by accident with a probability of about 2^-100.
/// Errors: bad-value, with the first difference found. Only name, components and association of
/// FieldInfo are compared, and nothing of the lattice.
[[nodiscard]] Result<VerifyReport> sameMesh(const LatticeMesh& decoded,
                                            const LatticeMesh& expected);

struct OnLattice {
  LatticeMesh mesh;
  double largestPositionError = 0;         ///< in lattice steps, 0.5 at most
  std::vector<double> largestFieldErrors;  ///< in field steps, one a field
  /// One a field, in its unit: from the input's values to those that an integer decodes to, in the
  /// field's type. Each is within largestRoundingError.
  std::vector<double> largestValueErrors;
};

/// Puts `mesh` on the lattice and the field scales that a log states, by the nearest integers, and
/// measures every error on the way. The result is what the log must hold, worked out without the
/// encoder's own quantiser. `fields` name those of `mesh` by name and association, in any order.
/// Errors: bad-value (a position or value further than half a step, and a billionth, from its
/// integer, or outside the bits; a value beyond largestRoundingError), not-found.
[[nodiscard]] Result<OnLattice> putOnLattice(const TetMesh& mesh, const Lattice& lattice,
                                             const std::vector<FieldInfo>& fields);

}  // namespace qtet
