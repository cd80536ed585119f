// The known error of a level against the original (FORMAT.md, "Known error"): what a manifest may
// say beside a level's counts.
#pragma once

#include <algorithm>
#include <optional>
#include <vector>

namespace qtet {

/// From one boundary to the nearest point of the other one, as fractions of the diagonal of the
/// original's bounding box.
struct OneSidedDistance {
  double mean = 0;
  double max = 0;
};

/// Over the original's volume, as fractions of the field's range. Where the field is a label
/// (Manifest::labels), `rms` is the share of the volume that has another one, and `max` 1 if any has.
struct FieldError {
  double rms = 0;
  double max = 0;
};

struct LevelError {
  OneSidedDistance toLevel;        ///< from the original's boundary to the level's
  OneSidedDistance toOriginal;     ///< and back
  double volumeLost = 0;           ///< the share of the original's volume that is not covered
  double volumeGained = 0;         ///< what is covered outside of it, over the original's volume
  std::vector<FieldError> fields;  ///< in the manifest's order

  /// The Hausdorff distance of the boundaries: the larger maximum of both ways.
  [[nodiscard]] double boundaryDistance() const { return std::max(toLevel.max, toOriginal.max); }
  /// The larger mean of both ways.
  [[nodiscard]] double boundaryMean() const { return std::max(toLevel.mean, toOriginal.mean); }
};

/// By level; none where it was not measured. Empty where no level was.
using LevelErrors = std::vector<std::optional<LevelError>>;

}  // namespace qtet
