// One field's floats or integers as lattice integers.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "codec/mesh.h"
#include "proto/error.h"
#include "simplify/tet_mesh.h"

namespace qtet {

struct QuantisedField {
  FieldInfo info;
  std::vector<std::int32_t> values;     ///< 0 in gaps
  std::uint64_t nonFinite = 0;          ///< values that are NaN or infinite: gaps
  std::vector<std::uint8_t> gaps{};     ///< one a value, 1 where it is a gap; empty without gaps
  bool exact = false;  ///< an integer field that loses nothing
};

/// The integer of `value` in component `component`: the nearest, within [0, 2^bits). REQUIRES: a finite value.
[[nodiscard]] std::int32_t fieldInteger(const FieldInfo& info, std::uint32_t component, double value);

/// See quantise(). Errors: bad-input (an extent above the largest double).
[[nodiscard]] Result<QuantisedField> quantiseField(const MeshField& field, int bits);

}  // namespace qtet
