// One field's floats or integers as lattice integers.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "codec/mesh/mesh.h"
#include "proto/error.h"
#include "simplify/mesh/tet_mesh.h"

namespace qtet {

/// Fields of more bits are not predicted in time (time_differences.cpp).
inline constexpr int kMaxScaleBits = 24;
/// The finest step of floats, in the field's unit. A smaller one is no normal number and would lose
/// its own digits.
inline constexpr double kFinestFieldStep = std::numeric_limits<double>::min();

struct QuantisedField {
  FieldInfo info;
  std::vector<std::int32_t> values;  ///< 0 in missing values
  std::uint64_t nonFinite = 0;       ///< values that are NaN or infinite: missing
  /// One a value, 1 where it is missing; empty without missing values.
  std::vector<std::uint8_t> missing{};
  bool exact = false;  ///< an integer field that loses nothing
};

/// The integer of `value` in component `component`: the nearest, within [0, 2^bits). REQUIRES: a
/// finite value.
[[nodiscard]] std::int32_t fieldInteger(const FieldInfo& info, std::uint32_t component,
                                        double value);

/// The box of a field's finite values, one interval a component; (infinity, -infinity) where there
/// are none.
struct FieldExtents {
  std::vector<double> minimum, maximum;

  /// The largest interval's length.
  [[nodiscard]] double largest() const;
  /// Takes the other's box in. REQUIRES: as many components.
  void include(const FieldExtents& other);
  /// Integers in this box are stored as they are.
  [[nodiscard]] bool fitsExactly() const;
};
[[nodiscard]] FieldExtents extentsOf(const MeshField& field);

/// How fine the values of a field are that is not stored exactly.
struct FieldPrecision {
  int bits = 12;
  /// Then the bits follow: largestRoundingError is within this, which is finite and not negative.
  std::optional<double> largestError{};
};

/// See quantise(). The integers are those of `extents`, the field's own or those of its series.
/// Errors: bad-input (an extent above the largest double), bad-value (an error that kMaxFieldBits
/// bits or the field's type cannot hold).
[[nodiscard]] Result<QuantisedField> quantiseField(const MeshField& field,
                                                   const FieldExtents& extents,
                                                   const FieldPrecision& precision);
/// For a field with values outside of the box `extents`, for which `precision` gives a step. The
/// field gets as many bits as it needs for a step no larger. Where the bits were given, they are
/// kMaxFieldBits at most, whatever the step. Errors: quantiseField's. REQUIRES: a field of floats.
[[nodiscard]] Result<QuantisedField> quantiseFiner(const MeshField& field,
                                                   const FieldExtents& extents,
                                                   const FieldPrecision& precision);
/// With step and minimum of `scale`, and its bits or as many more as values above it need. Nullopt
/// where a value lies below it or needs more than kMaxScaleBits, or where the fields differ in
/// components or type.
[[nodiscard]] std::optional<QuantisedField> quantiseAs(const FieldInfo& scale,
                                                       const MeshField& field);
/// Equal integers of both are equal values.
[[nodiscard]] bool haveOneScale(const FieldInfo& a, const FieldInfo& b);
/// The box of the values that the scale holds in its bits.
[[nodiscard]] FieldExtents extentsOf(const FieldInfo& scale);
[[nodiscard]] inline Result<QuantisedField> quantiseField(const MeshField& field, int bits) {
  return quantiseField(field, extentsOf(field), FieldPrecision{.bits = bits});
}

}  // namespace qtet
