// A field of a log, as far as decoding needs to know it.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "codec/mesh/time_parents.h"

namespace qtet {

/// The kind of element that a field's values belong to.
enum class Association : std::uint8_t { kPoint = 0, kCell = 1 };

/// The part of a field's description that decoding needs; the manifest has the rest.
struct FieldShape {
  std::uint32_t components = 1;  ///< 1..kMaxFieldComponents
  Association association = Association::kPoint;
  bool hasMissing = false;  ///< values may be missing: Values::codeOrMissing
  TimePrediction prediction{};
};

/// These fields and those that they are predicted from, ascending, each once. REQUIRES: `wanted`
/// are numbers of `fields`.
[[nodiscard]] std::vector<std::uint32_t> withParents(std::span<const FieldShape> fields,
                                                     std::span<const std::uint32_t> wanted);

}  // namespace qtet
