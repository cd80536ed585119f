// Warnings of a base mesh that has lost too much of the shape: how much, the most probable reason,
// and which options help.
#pragma once

#include <string>
#include <vector>

#include "codec/mesh/mesh.h"
#include "proto/manifest.h"
#include "simplify/clean/clean_mesh.h"

namespace qtet {

/// A base mesh may lose (or gain) this fraction of the volume without a warning. Real meshes lose
/// at most 1 % where the base mesh has enough cells, and 25 % and more where it has not.
inline constexpr double kVolumeLossWarned = 0.02;
/// The same for the boundary's greatest distance, a fraction of the diagonal: some 15 pixels of a
/// picture of 800.
inline constexpr double kBoundaryErrorWarned = 0.02;

/// The same for the share of the volume that has another label.
inline constexpr double kLabelErrorWarned = 0.02;

/// Walls thinner on average than this fraction of the diagonal: compact bodies have 0.07 to 0.19,
/// brackets and vessels 0.03. A boundary error that one hardly sees changes much of their volume.
inline constexpr double kThinWall = 0.05;
/// Points at the place of an earlier one, as a fraction of all points, from which on they are seams
/// and not a slit.
inline constexpr double kSeamPoints = 0.005;
/// A mesh falls into many parts from this number on, where its base mesh has fewer cells a part
/// than the second. A part of 100 tetrahedra still has the shape of a simple body.
inline constexpr std::uint64_t kManyParts = 8, kEnoughCellsAPart = 100;

/// The mean thickness of the mesh's walls, twice its volume over its boundary's area, as a fraction
/// of the diagonal of its box. 0 for a mesh without area.
[[nodiscard]] double wallThicknessOf(const LatticeMesh& mesh);

/// The facts in which the reason is looked for.
struct LossFacts {
  const CleanReport& clean;
  double wallThickness = 0;  ///< wallThicknessOf the original
  /// The boundary error that the user allowed; 0: he said nothing.
  double allowedBoundaryError = 0;
  bool hasTargetRatio = false;  ///< the user gave one
  bool isByRule = false;        ///< the base mesh was chosen by the rule that holds unasked
};

/// One sentence of the shape, and one a label. Empty too where no error was measured. REQUIRES: a manifest with levels.
[[nodiscard]] std::vector<std::string> lossWarnings(const Manifest& manifest,
                                                    const LossFacts& facts);

}  // namespace qtet
