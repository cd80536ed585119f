#include "simplify/clean/quantise.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "codec/mesh/boundary.h"
#include "codec/mesh/predicates.h"
#include "proto/limits.h"
#include "proto/number_text.h"
#include "simplify/clean/field_scales.h"
#include "simplify/clean/float_spacing.h"
#include "simplify/mesh/missing_values.h"
#include "simplify/mesh/stopping.h"
#include "simplify/mesh/volume_sign.h"

namespace qtet {
namespace {

struct Bounds {
  Position low{}, high{};

  [[nodiscard]] double extent() const {
    return std::max({high[0] - low[0], high[1] - low[1], high[2] - low[2]});
  }
};

Bounds boundsOf(const std::vector<Position>& points) {
  if (points.empty()) return {};
  Bounds box{points.front(), points.front()};
  for (const Position& p : points) {
    for (std::size_t k = 0; k < 3; ++k) {
      box.low[k] = std::min(box.low[k], p[k]);
      box.high[k] = std::max(box.high[k], p[k]);
    }
  }
  return box;
}

Lattice latticeOf(const Bounds& box, int bits) {
  const double extent = box.extent();
  return {bits, extent > 0 ? extent / (std::ldexp(1.0, bits) - 1) : 1.0, box.low};
}

std::vector<LatticePoint> onLattice(const std::vector<Position>& points, const Lattice& lattice) {
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

std::vector<signed char> signsOf(const TetMesh& mesh, const std::stop_token& stop) {
  std::vector<signed char> signs;
  signs.reserve(mesh.tetrahedra.size());
  for (const Tetrahedron& t : mesh.tetrahedra) {
    if (signs.size() % kLookEvery == 0) throwIfStopped(stop);
    signs.push_back(static_cast<signed char>(
        volumeSign(mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]], mesh.points[t[3]])));
  }
  return signs;
}

/// Cells that were positive and are not, or flat and are inverted.
Occurrences worseCells(const std::vector<Tetrahedron>& cells,
                       const std::vector<signed char>& before,
                       const std::vector<LatticePoint>& points, const std::stop_token& stop) {
  assert(before.size() == cells.size());
  Occurrences worse;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (i % kLookEvery == 0) throwIfStopped(stop);
    if (before[i] < 0) continue;
    const Tetrahedron& t = cells[i];
    const int now = orientation(points[t[0]], points[t[1]], points[t[2]], points[t[3]]);
    if (now < 0 || (now == 0 && before[i] > 0)) worse.add(i);
  }
  return worse;
}

Status checkOptions(const QuantiseOptions& options) {
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

Status checkBox(const Bounds& box) {
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

/// Finds the bits and places the points. REQUIRES: checked options and box.
void placePoints(const TetMesh& mesh, const Bounds& box, const std::stop_token& stop,
                 QuantisedMesh& out) {
  const std::vector<signed char> before = signsOf(mesh, stop);
  QuantiseReport& report = out.report;
  if (std::optional<std::string> lost = lostToFloats(mesh))
    report.notes.push_back(std::move(*lost));
  for (int bits = report.requestedBits;; ++bits) {
    throwIfStopped(stop);
    out.mesh.lattice = latticeOf(box, bits);
    out.mesh.points = onLattice(mesh.points, out.mesh.lattice);
    report.worseCells = worseCells(mesh.tetrahedra, before, out.mesh.points, stop);
    if (bits == report.requestedBits) report.worseAtRequestedBits = report.worseCells.count;
    if (report.worseCells.count == 0 || bits == kMaxPositionBits) break;
  }
  if (out.mesh.lattice.bits > report.requestedBits) {
    report.notes.push_back("positions take " + std::to_string(out.mesh.lattice.bits) +
                           " bits an axis instead of " + std::to_string(report.requestedBits) +
                           ", at which " + std::to_string(report.worseAtRequestedBits) +
                           " cells would be flattened or inverted");
  }
  if (report.worseCells.count > 0) {
    report.notes.push_back(
        std::to_string(report.worseCells.count) + " cells are flattened or inverted even at " +
        std::to_string(kMaxPositionBits) + " bits an axis, the first is cell " +
        std::to_string(report.worseCells.first.front()) + " of the cleaned mesh");
  }
}

/// A lattice has one step on all axes, so it holds no mesh that is much thinner than long.
Status checkWorse(const TetMesh& mesh, const Bounds& box, const QuantiseReport& report) {
  const auto cells = static_cast<double>(mesh.tetrahedra.size());
  if (static_cast<double>(report.worseCells.count) <= kMostWorseCells * cells) return {};
  const double step = box.extent() / std::ldexp(1.0, kMaxPositionBits);
  return fail(ErrorCode::kBadInput,
              std::to_string(report.worseCells.count) + " of its " +
                  std::to_string(mesh.tetrahedra.size()) +
                  " cells would be flattened: the finest lattice has a step of " +
                  shortestText(step) +
                  ", and they are thinner; scale the long axis down, or cut the mesh to where it "
                  "has its cells");
}

Status placeFields(const TetMesh& mesh, const QuantiseOptions& options, const std::stop_token& stop,
                   QuantisedMesh& out) {
  const int bits = options.fieldBits;
  const std::vector<std::optional<ValueBound>> bounds = valueBoundsOf(mesh.fields, options.errors);
  const FieldScales all = scalesOf(mesh.fields);
  out.report.warnings = all.outlying.warnings();
  for (std::size_t f = 0; f < mesh.fields.size(); ++f) {
    const MeshField& field = mesh.fields[f];
    throwIfStopped(stop);
    const std::string name = (isCellField(field) ? "cell field " : "field ") + field.name;
    Result<QuantisedField> quantised = quantiseBy(all.scales[f], field, bits, bounds[f]);
    if (!quantised) return std::unexpected(quantised.error());
    out.report.nonFiniteOf.push_back(quantised->nonFinite);
    if (quantised->nonFinite > 0) {
      out.report.nonFiniteValues += quantised->nonFinite;
      out.report.notes.push_back(name + ": " + std::to_string(quantised->nonFinite) +
                                 " values are NaN or infinite and come back as NaN");
    }
    if (isFloatType(field.type) && !bounds[f] && quantised->info.step == kFinestFieldStep)
      out.report.notes.push_back(
          name + ": its values span " + roundedText(all.scales[f].extents.largest()) +
          ", and the finest step of a log is " + roundedText(kFinestFieldStep) +
          "; multiply them, such as by 1e300, or keep its own values by `lossless`");
    if (!quantised->exact && !isFloatType(field.type)) {
      out.report.notes.push_back(name + ": its integers span more than " +
                                 std::to_string(kMaxFieldBits) + " bits and are rounded to " +
                                 std::to_string(quantised->info.bits) + " bits");
    }
    out.mesh.fields.push_back(std::move(quantised->info));
    if (quantised->nonFinite > 0)
      fillMissing(mesh.tetrahedra, out.mesh.fields.back(), quantised->missing, quantised->values);
    assert(quantised->values.size() == field.values.size());
    assert(quantised->missing.empty() == (quantised->nonFinite == 0));
    out.mesh.values.push_back(std::move(quantised->values));
    out.missing.push_back(std::move(quantised->missing));
  }
  return {};
}

Result<QuantisedMesh> place(const TetMesh& mesh, const QuantiseOptions& options,
                            const std::stop_token& stop, std::vector<Triangle> boundary) {
  if (Status checked = checkOptions(options); !checked) return std::unexpected(checked.error());
  const Bounds box = boundsOf(mesh.points);
  if (Status checked = checkBox(box); !checked) return std::unexpected(checked.error());

  QuantisedMesh out;
  out.report.requestedBits = options.positionBits;
  placePoints(mesh, box, stop, out);
  if (Status checked = checkWorse(mesh, box, out.report); !checked)
    return std::unexpected(checked.error());
  out.mesh.tetrahedra = mesh.tetrahedra;
  out.mesh.boundary =
      boundary.empty() ? boundaryOf(mesh.tetrahedra, StopFlag(stop).get()) : std::move(boundary);
  throwIfStopped(stop);
  if (Status placed = placeFields(mesh, options, stop, out); !placed)
    return std::unexpected(placed.error());
  assert(out.mesh.points.size() == mesh.points.size() &&
         out.mesh.fields.size() == mesh.fields.size());
  return out;
}

}  // namespace

Result<QuantisedMesh> quantise(const TetMesh& mesh, const QuantiseOptions& options,
                               const std::stop_token& stop, std::vector<Triangle> boundary) {
  return orCancelled([&] { return place(mesh, options, stop, std::move(boundary)); });
}

}  // namespace qtet
