// The input's own numbers, bit for bit, coded as corrections to the values of the lattice or of a
// field's scale (CLOSING.md, "Exact values").
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "proto/bytes.h"
#include "proto/error.h"

namespace qtet {

/// An attribute as encoder and decoder know it: integers in slot order, and the number that each
/// stands for.
struct Approximation {
  std::span<const std::int32_t> integers;  ///< components a point or cell; kMissing for NaN
  std::uint32_t components = 1;
  std::vector<double> minimum;  ///< one a component
  double step = 1;
  /// Float32, float64, or an integer type of up to 2^53 in magnitude.
  std::string type = "float32";
};

/// Corrections that turn the approximation into `exact`, as many numbers as integers, each
/// representable in the type. NaN keep their payload.
[[nodiscard]] Bytes encodeExact(const Approximation& known, std::span<const double> exact);

/// The inverse. Errors: bad-value (the block is longer or shorter than its numbers, or holds none
/// of the type).
[[nodiscard]] Result<std::vector<double>> decodeExact(const Approximation& known, ByteView bytes);

}  // namespace qtet
