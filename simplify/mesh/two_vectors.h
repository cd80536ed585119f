// Two vectors at a time, as pairs (codec/coding/pair.h). Each of the two is computed as it would be
// alone, so that every machine gets the same bits.
#pragma once

#include <array>

#include "codec/coding/pair.h"
#include "simplify/mesh/vector3.h"

namespace qtet {

/// Two vectors, coordinate by coordinate.
using TwoVectors = std::array<Pair, 3>;

[[nodiscard]] inline TwoVectors both(const Vector3& a, const Vector3& b) {
  return {Pair{a[0], b[0]}, Pair{a[1], b[1]}, Pair{a[2], b[2]}};
}
[[nodiscard]] inline TwoVectors operator-(const TwoVectors& a, const TwoVectors& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
[[nodiscard]] inline TwoVectors operator+(const TwoVectors& a, const TwoVectors& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
[[nodiscard]] inline Pair dot(const TwoVectors& a, const TwoVectors& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
[[nodiscard]] inline TwoVectors cross(const TwoVectors& a, const TwoVectors& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

}  // namespace qtet
