// Points that move over the steps of a file: how far each one is from where it rests.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "simplify/mesh/moved_place.h"
#include "simplify/split/cell_mesh.h"

namespace qtet {

/// The name of displacements where the file has a field kDisplacement (moved_place.h) of its own.
inline constexpr std::string_view kMotionField = "Motion";

/// Whether both lists have the same places; two that are NaN are one place.
[[nodiscard]] bool areSamePoints(std::span<const Position> a, std::span<const Position> b);

/// kDisplacement, or if `step` has a field of that name kMotionField, Motion-2 and so on.
/// Fields that were not read count, too; a time behind a name does not.
[[nodiscard]] std::string displacementName(const CellMesh& step);

/// float32 where both meshes have points of that type, else float64.
[[nodiscard]] std::string displacementType(const CellMesh& rest, const CellMesh& step);

/// The point field `points` - rest.points, rounded to `type`; it has no name. A point that no cell
/// uses has 0 where a coordinate is not finite. Errors: bad-input, without the file's name (another
/// number of points; a point of a cell whose displacement is not finite). REQUIRES: `type` float32
/// or float64; vertex ids of `rest` may lie outside of its points.
[[nodiscard]] Result<MeshField> displacementOf(const CellMesh& rest,
                                               std::span<const Position> points,
                                               const std::string& type);

/// The length of the longest of a field's vectors. REQUIRES: 3 components, finite values.
[[nodiscard]] double largestDisplacement(const MeshField& field);

}  // namespace qtet
