// Where the places of a measurement lay in each level. Fields whose fused values have moved since
// are measured again there, without following the places through the fusions once more.
#pragma once

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "codec/record/fusion_history.h"
#include "proto/level_error.h"

namespace qtet {

/// A place in the cell of a level that holds it, or on the boundary triangle nearest to it.
struct ReplayedPlace {
  std::uint32_t place = 0;
  bool isOriginal = true;             ///< whether the level has there what the original has
  std::array<VertexId, 4> corners{};  ///< the last one is kGhost in a triangle
  std::array<double, 4> weights{};
};

/// A component of a point field at a place, from the values of all vertices.
[[nodiscard]] inline double valueIn(const std::array<VertexId, 4>& corners,
                                    const std::array<double, 4>& weights,
                                    const std::vector<std::int32_t>& values, std::size_t components,
                                    std::size_t component) {
  assert(component < components);
  const std::size_t count = corners[3] == kGhost ? 3 : 4;
  double out = 0;
  for (std::size_t i = 0; i < count; ++i)
    out += weights[i] * values[corners[i] * components + component];
  return out;
}

/// The error of a field from its squared errors at places, the first `uniform` of which count for
/// the mean. A level that has other values than the original's does not know how those were
/// rounded: the difference has the error of rounding in it. It comes to that of the others,
/// `isOriginal(place)`, and to the maximum.
template <class IsOriginal>
[[nodiscard]] FieldError errorOf(const std::vector<double>& squared, std::size_t uniform,
                                 const FieldError& rounding, const IsOriginal& isOriginal) {
  assert(uniform <= squared.size());
  const double added = rounding.rms * rounding.rms;
  double sum = 0, worst = 0;
  for (std::size_t i = 0; i < squared.size(); ++i) {
    if (i < uniform) sum += squared[i] + (isOriginal(i) ? added : 0);
    worst = std::max(worst, squared[i]);
  }
  return {uniform == 0 ? 0 : std::sqrt(sum / static_cast<double>(uniform)),
          std::sqrt(worst) + rounding.max};
}

/// A FieldMeter leaves it.
struct FieldReplay {
  struct Level {
    std::uint32_t coarser = 0;         ///< steps from the finest level
    std::vector<ReplayedPlace> moved;  ///< since the level before; all in the first
  };
  std::vector<Level> levels;  ///< those that were measured, the finest first
  /// Per field, components a place. Empty: the values of the finest level.
  std::vector<std::vector<double>> truth{};
  std::size_t uniform = 0;
  std::vector<double> ranges;         ///< a field's, in its steps; 0: it is constant
  std::vector<FieldError> roundings;  ///< a field's

  /// The errors of a point field that is no label, one a level, as they would be measured now. The
  /// first `unmeasured` fields of the history were not. REQUIRES: its vertices are those that were
  /// measured.
  [[nodiscard]] std::vector<FieldError> errors(const FusionHistory& history, std::size_t field,
                                               std::size_t unmeasured) const;
};

}  // namespace qtet
