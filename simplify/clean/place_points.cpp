#include "simplify/clean/place_points.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "proto/limits.h"
#include "proto/number_text.h"

namespace qtet {

void PointBox::include(std::span<const Position> points) {
  for (const Position& p : points) {
    if (isEmpty) low = high = p, isEmpty = false;
    for (std::size_t k = 0; k < 3; ++k) {
      low[k] = std::min(low[k], p[k]);
      high[k] = std::max(high[k], p[k]);
    }
  }
}

double PointBox::extent() const {
  return std::max({high[0] - low[0], high[1] - low[1], high[2] - low[2]});
}

Lattice latticeOf(const PointBox& box, int bits) {
  const double extent = box.extent();
  return {bits, extent > 0 ? extent / (std::ldexp(1.0, bits) - 1) : 1.0, box.low};
}

std::vector<LatticePoint> onLattice(std::span<const Position> points, const Lattice& lattice) {
  assert(lattice.step > 0 && lattice.bits <= kMaxPositionBits);
  const double highest = std::ldexp(1.0, lattice.bits) - 1;
  std::vector<LatticePoint> out;
  out.reserve(points.size());
  for (const Position& p : points) {
    LatticePoint q;
    for (std::size_t k = 0; k < 3; ++k) {
      q[k] = static_cast<std::int32_t>(
          std::clamp(std::floor((p[k] - lattice.origin[k]) / lattice.step + 0.5), 0.0, highest));
    }
    out.push_back(q);
  }
  return out;
}

Status checkQuantiseOptions(const QuantiseOptions& options) {
  const auto isWithin = [](int value, int low, int high) { return value >= low && value <= high; };
  if (!isWithin(options.positionBits, kMinPositionBits, kMaxPositionBits)) {
    return fail(ErrorCode::kBadValue, "position bits " + std::to_string(options.positionBits) +
                                          " are outside " + std::to_string(kMinPositionBits) +
                                          " to " + std::to_string(kMaxPositionBits));
  }
  if (!isWithin(options.fieldBits, kMinFieldBits, kMaxFieldBits)) {
    return fail(ErrorCode::kBadValue, "field bits " + std::to_string(options.fieldBits) +
                                          " are outside " + std::to_string(kMinFieldBits) + " to " +
                                          std::to_string(kMaxFieldBits));
  }
  return {};
}

Status checkBox(const PointBox& box) {
  const double extent = box.extent();
  if (!std::isfinite(extent))
    return fail(ErrorCode::kBadInput,
                "the mesh is larger than the largest float64; multiply its coordinates, such as by "
                "1e-10");
  const double least = std::numeric_limits<double>::min() * std::ldexp(1.0, kMaxPositionBits);
  if (extent > 0 && extent < least)
    return fail(ErrorCode::kBadInput,
                "the mesh is " + roundedText(extent) + " units large, and the lattice needs " +
                    roundedText(least) + " at least; multiply its coordinates, such as by 1e300");
  return {};
}

void notePositions(int bits, QuantiseReport& report) {
  if (bits > report.requestedBits) {
    report.notes.push_back("positions take " + std::to_string(bits) + " bits an axis instead of " +
                           std::to_string(report.requestedBits) + ", at which " +
                           std::to_string(report.worseAtRequestedBits) +
                           " cells would be flattened or inverted");
  }
  if (report.worseCells.count > 0) {
    report.notes.push_back(
        std::to_string(report.worseCells.count) + " cells are flattened or inverted even at " +
        std::to_string(kMaxPositionBits) + " bits an axis, the first is cell " +
        std::to_string(report.worseCells.first.front()) + " of the cleaned mesh");
  }
}

Status checkWorse(std::uint64_t count, const PointBox& box, const QuantiseReport& report) {
  const auto cells = static_cast<double>(count);
  if (static_cast<double>(report.worseCells.count) <= kMostWorseCells * cells) return {};
  const double step = box.extent() / std::ldexp(1.0, kMaxPositionBits);
  return fail(ErrorCode::kBadInput,
              std::to_string(report.worseCells.count) + " of its " + std::to_string(count) +
                  " cells would be flattened: the finest lattice has a step of " +
                  shortestText(step) +
                  ", and they are thinner; scale the long axis down, or cut the mesh to where it "
                  "has its cells");
}

}  // namespace qtet
