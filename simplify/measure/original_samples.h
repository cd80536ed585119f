// The original that a mesh was reduced from before its history began (BLOCKS.md, "Known error"). It
// is places with their values, and how far the reduction has gone.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "codec/mesh/mesh.h"
#include "proto/level_error.h"
#include "simplify/measure/measure_samples.h"
#include "simplify/mesh/vector3.h"

namespace qtet {

/// A place of the original, and where the mesh has it now.
struct FollowedPlace {
  Vector3 at;
  /// The cell that holds the place. If none does: a cell with the nearest boundary triangle.
  CellId tetrahedron = 0;
  bool isCovered = true;
  bool isOriginal = true;  ///< the cell is what and where it is in the original
};

/// Lengths are in lattice steps.
struct OriginalSamples {
  std::vector<FollowedPlace> places;
  std::size_t uniform = 0;  ///< the first places, uniform in the volume; the others are vertices
  std::vector<std::vector<double>> truth;  ///< per field, its integers' components a place
  std::vector<double> ranges;              ///< per field, the diagonal of the box of its integers
  std::vector<Vector3> surface;            ///< places uniform on the boundary
  /// Between the original's boundary and that of the mesh: upper bounds of the largest distance,
  /// and an estimate of the mean one.
  OneSidedDistance toMesh, toOriginal;
  double diagonal = 1;
  double volume6 = 0;  ///< six times the volume
};

/// How many places stand for an original.
struct SampleCounts {
  std::uint32_t volume = 0;  ///< uniform in its volume
  /// Vertices at most, for the maximum: an error is largest at a vertex of one of the meshes.
  std::uint32_t vertices = 0;
};
struct SampledPlaces {
  std::vector<ErrorSample> places;
  std::size_t uniform = 0;  ///< the first of them
};
/// The places of a mesh of these tetrahedra. Vertices are every so-many-th, in the order in which
/// the cells meet them, each in the first cell that has it.
[[nodiscard]] SampledPlaces placesOf(std::span<const LatticePoint> points, CellSpan cells,
                                     const SampleCounts& counts, std::uint64_t seed);
/// OriginalSamples::ranges of a mesh with these tetrahedra.
[[nodiscard]] std::vector<double> rangesOf(std::span<const FieldInfo> fields,
                                           std::span<const std::vector<std::int32_t>> values,
                                           CellSpan cells, std::size_t points);

}  // namespace qtet
