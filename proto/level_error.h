// The known error of a level against the original (FORMAT.md, "Known error"): what a manifest may
// say beside a level's counts.
#pragma once

#include <algorithm>
#include <vector>

namespace qtet {

/// From one boundary to the nearest point of the other one, as fractions of the diagonal of the
/// original's bounding box.
struct OneSidedDistance {
  double mean = 0;
  double max = 0;
};

/// Over the original's volume, as fractions of the field's range.
struct FieldError {
  double rms = 0;
  double max = 0;
};

struct LevelError {
  OneSidedDistance toLevel;        ///< from the original's boundary to the level's
  OneSidedDistance toOriginal;     ///< and back
  double volumeKept = 1;           ///< the level's volume over the original's
  std::vector<FieldError> fields;  ///< in the manifest's order

  /// The Hausdorff distance of the boundaries: the larger maximum of both ways.
  [[nodiscard]] double boundaryDistance() const { return std::max(toLevel.max, toOriginal.max); }
  /// The larger mean of both ways.
  [[nodiscard]] double boundaryMean() const { return std::max(toLevel.mean, toOriginal.mean); }
};

}  // namespace qtet
