#include "simplify/read/abaqus/placement.h"

#include <cassert>
#include <cmath>

namespace qtet {
namespace {

constexpr double kPi = 3.14159265358979323846;

Position difference(const Position& a, const Position& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
Position cross(const Position& a, const Position& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
/// nullopt: it has no direction.
std::optional<Position> unit(const Position& a) {
  const double length = std::sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
  if (!(length > 0) || !std::isfinite(length)) return std::nullopt;
  return Position{a[0] / length, a[1] / length, a[2] / length};
}
Position point(std::span<const double> numbers, std::size_t first) {
  return {numbers[first], numbers[first + 1], numbers[first + 2]};
}

/// The series of the sine (first: 1) or cosine (first: 0) at an angle of at most pi/4. The term
/// after the last one is below 1e-19.
double series(double radians, int first) {
  double term = first == 1 ? radians : 1, sum = term;
  for (int n = first + 1; n < first + 18; n += 2) {
    term *= -radians * radians / (n * (n + 1));
    sum += term;
  }
  return sum;
}

}  // namespace

Position AbaqusPlacement::operator()(const Position& p) const {
  Position out = origin;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t k = 0; k < 3; ++k) out[k] += axes[i][k] * p[i];
  return out;
}

Turn turnOf(double degrees) {
  if (!std::isfinite(degrees)) return {degrees - degrees, degrees - degrees};
  // both remainders are exact
  const double whole = std::fmod(degrees, 360), rest = std::remainder(whole, 90);
  const int quarters = (static_cast<int>((whole - rest) / 90 + (whole < 0 ? -0.5 : 0.5)) + 8) % 4;
  const double radians = rest * (kPi / 180), sine = series(radians, 1), cosine = series(radians, 0);
  switch (quarters) {
    case 1: return {cosine, -sine};
    case 2: return {-sine, -cosine};
    case 3: return {-cosine, sine};
    default: return {sine, cosine};
  }
}

Position fromCylindrical(const Position& p) {
  const Turn turn = turnOf(p[1]);
  return {p[0] * turn.cosine, p[0] * turn.sine, p[2]};
}

Position fromSpherical(const Position& p) {
  const Turn up = turnOf(p[2]);
  return fromCylindrical({p[0] * up.cosine, p[1], p[0] * up.sine});
}

std::optional<AbaqusPlacement> systemOf(std::span<const double> numbers) {
  if (numbers.empty()) return AbaqusPlacement{};
  if (numbers.size() != 3 && numbers.size() != 6 && numbers.size() != 9) return std::nullopt;
  AbaqusPlacement out;
  out.origin = point(numbers, 0);
  if (numbers.size() == 3) return out;
  Position along = difference(point(numbers, 3), out.origin);
  Position within{-along[1], along[0], 0};
  if (numbers.size() == 6)
    along[2] = 0;
  else
    within = difference(point(numbers, 6), out.origin);
  const auto x = unit(along), z = unit(cross(along, within));
  if (!x || !z) return std::nullopt;
  out.axes = {*x, cross(*z, *x), *z};
  return out;
}

std::optional<AbaqusPlacement> instanceAt(const Position& shift, std::span<const double> turn) {
  AbaqusPlacement out;
  out.origin = shift;
  if (turn.empty()) return out;
  assert(turn.size() == 7);
  const Position foot = point(turn, 0);
  const auto axis = unit(difference(point(turn, 3), foot));
  if (!axis) return std::nullopt;
  const Turn angle = turnOf(turn[6]);
  const Position& a = *axis;
  // Rodrigues' formula, a column for each axis
  for (std::size_t i = 0; i < 3; ++i) {
    Position e{0, 0, 0};
    e[i] = 1;
    const Position side = cross(a, e);
    for (std::size_t k = 0; k < 3; ++k)
      out.axes[i][k] =
          e[k] * angle.cosine + side[k] * angle.sine + a[k] * a[i] * (1 - angle.cosine);
  }
  AbaqusPlacement turned = out;
  turned.origin = foot;
  out.origin = turned(difference(shift, foot));
  return out;
}

}  // namespace qtet
