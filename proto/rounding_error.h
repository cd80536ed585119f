// How far rounding takes a field's values from those of the input. It follows from what the
// manifest says of the field.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string_view>

namespace qtet {

/// The arithmetic and the type may add this to half a step, for values of this magnitude at most.
/// In double precision, placing a value takes 3 roundings, and decoding it 2. Each is within 2^-53
/// of a number of twice the magnitude, so 2^-49 has room. A float32 is within 2^-24 of the
/// magnitude, or half of the least float32. An integer is within a half.
[[nodiscard]] inline double typeRounding(std::string_view type, double magnitude) {
  const double arithmetic = std::ldexp(magnitude, -49);
  if (type == "float32") return arithmetic + std::ldexp(magnitude, -24) + std::ldexp(1.0, -150);
  return type == "float64" ? arithmetic : arithmetic + 0.5;
}

/// The largest magnitude that the field's bits hold. `Field` is a ManifestField or a FieldInfo.
template <class Field>
[[nodiscard]] double largestMagnitude(const Field& field) {
  const double span = field.step * (std::ldexp(1.0, field.bits) - 1);
  double out = 0;
  for (const double low : field.minimum) out = std::max({out, std::abs(low), std::abs(low + span)});
  return out;
}

/// Whether every value of the finest level is the input's own: integers of step 1, or one float
/// everywhere.
template <class Field>
[[nodiscard]] bool isStoredExactly(const Field& field) {
  if (!field.type.starts_with("float")) return field.step == 1;
  return field.components == 1 && field.range[0] == field.range[1] &&
         field.range[0] == field.minimum[0];
}

/// The most that a value of the finest level, in the input's type, may differ from the input's,
/// each component by itself. In the field's unit; 0 where isStoredExactly.
template <class Field>
[[nodiscard]] double largestRoundingError(const Field& field) {
  if (isStoredExactly(field)) return 0;
  return 0.5 * field.step + typeRounding(field.type, largestMagnitude(field));
}

}  // namespace qtet
