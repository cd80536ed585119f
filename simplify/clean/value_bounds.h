// Errors that the user allows: how far the values of a field may be from the input's.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "proto/error.h"
#include "proto/manifest.h"
#include "simplify/mesh/tet_mesh.h"

namespace qtet {

/// For each component of each value.
struct ValueBound {
  double value = 0;    ///< above 0, finite
  std::string unit{};  ///< "%": per cent of the field's range; else the field's unit, or empty
  /// With "%" of a series that is added: the range of its scale, where that is known (withRanges).
  std::optional<double> range{};

  [[nodiscard]] bool isOfRange() const { return unit == "%"; }
};

/// By a field's name, or that of a series for all its instants (fieldsOfKey). "all" means every
/// field of floats that no other name means, unless a field is called so. The last name counts
/// where several mean one field.
using ValueBounds = std::vector<std::pair<std::string, ValueBound>>;

/// The bound of each field. Names of no field mean nothing.
[[nodiscard]] std::vector<std::optional<ValueBound>> valueBoundsOf(
    std::span<const MeshField> fields, const ValueBounds& bounds);

/// Errors: bad-value (a bound that is not above 0 or not finite; a unit that is not the field's),
/// not-found (a name of no field).
[[nodiscard]] Status checkValueBounds(std::span<const MeshField> fields, const ValueBounds& bounds,
                                      const Units& units);

}  // namespace qtet
