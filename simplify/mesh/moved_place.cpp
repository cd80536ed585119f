#include "simplify/mesh/moved_place.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "codec/mesh/predicates.h"
#include "proto/field_name.h"

namespace qtet {
namespace {

constexpr double kFarthest = 0x1p38;

detail::Difference difference(const MovedPoint& from, const MovedPoint& to) {
  return {to[0] - from[0], to[1] - from[1], to[2] - from[2]};
}

/// u x v . w; below 2^126 for components up to 2^40.
Int128 wideDeterminant(const detail::Difference& u, const detail::Difference& v,
                       const detail::Difference& w) {
  return (Int128{u.y} * v.z - Int128{u.z} * v.y) * w.x +
         (Int128{u.z} * v.x - Int128{u.x} * v.z) * w.y +
         (Int128{u.x} * v.y - Int128{u.y} * v.x) * w.z;
}

template <class Number>
int signOf(Number x) {
  return (x > 0) - (x < 0);
}

bool isConstant(std::span<const std::int32_t> values) {
  assert(values.size() >= 3 && values.size() % 3 == 0);
  return std::ranges::equal(values.first(values.size() - 3), values.subspan(3));
}

}  // namespace

MovedPoint movedPoint(const Lattice& lattice, const FieldInfo& field, const LatticePoint& point,
                      std::span<const std::int32_t> integers) {
  MovedPoint out{};
  assert(integers.size() == 3 && lattice.step > 0);
  for (std::size_t c = 0; c < 3; ++c) {
    assert(integers[c] != kMissing);
    const double by = field.value(c, integers[c]) / lattice.step;
    const double rounded = std::clamp(std::floor(by + 0.5), -kFarthest, kFarthest);
    out[c] = point[c] + static_cast<std::int64_t>(rounded);
  }
  return out;
}

int movedOrientation(const MovedPoint& a, const MovedPoint& b, const MovedPoint& c,
                     const MovedPoint& d) {
  const detail::Difference u = difference(a, b), v = difference(a, c), w = difference(a, d);
  if (detail::isShort(u, v, w)) return signOf(detail::determinant<std::int64_t>(u, v, w));
  return signOf(wideDeterminant(u, v, w));
}

std::vector<std::size_t> displacementFields(std::span<const FieldInfo> fields) {
  struct Instant {
    double time;
    std::size_t field;
  };
  std::vector<Instant> found;
  for (std::size_t f = 0; f < fields.size(); ++f) {
    if (isCellField(fields[f]) || fields[f].components != 3) continue;
    const auto instant = fields[f].name.instant();
    if (instant ? instant->series == kDisplacement : fields[f].name == kDisplacement)
      found.push_back({instant ? instant->time : 0, f});
  }
  std::ranges::sort(found, [](const Instant& a, const Instant& b) {
    return a.time != b.time ? a.time < b.time : a.field < b.field;
  });
  std::vector<std::size_t> out;
  for (const Instant& instant : found) out.push_back(instant.field);
  return out;
}

std::vector<std::size_t> sampledDisplacements(const LatticeMesh& mesh, std::size_t most) {
  assert(mesh.values.size() == mesh.fields.size());
  std::vector<std::size_t> all = displacementFields(mesh.fields);
  std::erase_if(
      all, [&](std::size_t f) { return mesh.values[f].size() < 3 || isConstant(mesh.values[f]); });
  if (all.size() <= most || most == 0) return most == 0 ? std::vector<std::size_t>{} : all;
  if (most == 1) return {all.back()};
  std::vector<std::size_t> out;
  for (std::size_t i = 0; i < most; ++i) out.push_back(all[i * (all.size() - 1) / (most - 1)]);
  return out;
}

}  // namespace qtet
