// One field's floats or integers as lattice integers.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "codec/mesh/mesh.h"
#include "proto/error.h"
#include "simplify/mesh/tet_mesh.h"

namespace qtet {

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

/// See quantise(). Errors: bad-input (an extent above the largest double).
[[nodiscard]] Result<QuantisedField> quantiseField(const MeshField& field, int bits);

}  // namespace qtet
