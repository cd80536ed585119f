// Where vertices are at the instants of a field of displacements, on a lattice that has no end.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "codec/mesh/mesh.h"

namespace qtet {

/// The point field of 3 components that says how far a point is from its place at rest, in the
/// mesh's unit. It is one field, or a series of this name.
inline constexpr std::string_view kDisplacement = "Displacement";

/// Lattice coordinates that may lie outside of the lattice, each at most 2^39 in magnitude.
using MovedPoint = std::array<std::int64_t, 3>;

/// The point and its displacement in lattice steps, rounded to integers, halves up. A displacement
/// of more than 2^38 steps is cut off there. `integers` are the field's three of this vertex, none
/// missing.
[[nodiscard]] MovedPoint movedPoint(const Lattice& lattice, const FieldInfo& field,
                                    const LatticePoint& point,
                                    std::span<const std::int32_t> integers);

/// The sign of the volume of (a, b, c, d), exactly: as orientation (codec/mesh/predicates.h).
[[nodiscard]] int movedOrientation(const MovedPoint& a, const MovedPoint& b, const MovedPoint& c,
                                   const MovedPoint& d);

/// The numbers of the fields of displacements, instants by time.
[[nodiscard]] std::vector<std::size_t> displacementFields(std::span<const FieldInfo> fields);

/// `most` of the mesh's displacementFields at most, evenly from the first to the last. One that is
/// constant is left out before: the mesh is only shifted, or rests.
[[nodiscard]] std::vector<std::size_t> sampledDisplacements(const LatticeMesh& mesh,
                                                            std::size_t most);

}  // namespace qtet
