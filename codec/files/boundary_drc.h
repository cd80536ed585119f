// The boundary surface of a mesh as a standard Draco mesh, for viewers that know triangles and
// nothing of logs.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "codec/mesh/mesh.h"
#include "proto/bytes.h"
#include "proto/error.h"

namespace qtet {

struct DrcOptions {
  /// One a point of the mesh, or none: a COLOR of three normalised bytes, after everything else and
  /// without loss.
  std::span<const std::array<std::uint8_t, 3>> colours{};
  std::array<double, 3> from{};  ///< origin of the positions, in the mesh's units
};

/// Encodes `mesh.boundary` and its vertices. POSITION is float32, in world coordinates less `from`,
/// quantised on the mesh's own lattice. Each point field is one GENERIC float32 attribute,
/// quantised on the field's own steps, with its name in the attribute's metadata under "name". Cell
/// fields are left out.
/// The decoder reorders vertices and triangles. Lattice points survive while |origin / step| +
/// 2^bits <= 2^19: round((x - origin) / step) gives them back. The float then loses at most 2^-5 of
/// a step, twice, and Draco's three roundings at most 2^-2 together. Further out float32 cannot
/// represent them apart, and positions are the nearest floats. The same holds for fields, with
/// minimum and step. A field of more bits, with missing values (NaN), or with integers beyond 2^20,
/// is stored as raw floats.
/// REQUIRES: indices within range, as many values as the fields' components say, lattice.bits and
/// field bits within proto/limits.h. Errors: bad-input (no boundary; coordinates of 1e38 and more;
/// more than kMaxDracoAttributes point fields, and colours), bad-codec (Draco refused, with its
/// message).
[[nodiscard]] Result<Bytes> boundaryDrc(const LatticeMesh& mesh, const DrcOptions& options = {});

/// Whether float32 distinguishes each lattice point from its neighbours, with the room that
/// boundaryDrc needs.
[[nodiscard]] bool floatsHold(const Lattice& lattice);

}  // namespace qtet
