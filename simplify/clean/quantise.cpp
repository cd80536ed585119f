#include "simplify/clean/quantise.h"

#include <algorithm>
#include <cassert>
#include <optional>
#include <utility>

#include "codec/mesh/boundary.h"
#include "proto/limits.h"
#include "simplify/clean/float_spacing.h"
#include "simplify/clean/place_fields.h"
#include "simplify/clean/place_points.h"
#include "simplify/mesh/missing_values.h"
#include "simplify/mesh/stopping.h"
#include "simplify/mesh/volume_sign.h"

namespace qtet {
namespace {

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
    const Tetrahedron& t = cells[i];
    if (isWorse(before[i], {points[t[0]], points[t[1]], points[t[2]], points[t[3]]})) worse.add(i);
  }
  return worse;
}

/// Finds the bits and places the points. REQUIRES: checked options and box.
void placePoints(const TetMesh& mesh, const PointBox& box, const std::stop_token& stop,
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
  notePositions(out.mesh.lattice.bits, report);
}

Status takeFields(const TetMesh& mesh, const QuantiseOptions& options, const std::stop_token& stop,
                  QuantisedMesh& out) {
  Result<PlacedFields> placed = placeFields(mesh.fields, options, stop);
  if (!placed) return std::unexpected(placed.error());
  for (QuantisedField& field : placed->fields) {
    out.report.nonFiniteOf.push_back(field.nonFinite);
    out.mesh.fields.push_back(std::move(field.info));
    if (field.nonFinite > 0)
      fillMissing(mesh.tetrahedra, out.mesh.fields.back(), field.missing, field.values);
    out.mesh.values.push_back(std::move(field.values));
    out.missing.push_back(std::move(field.missing));
  }
  noteFields(*placed, out.mesh.fields, out.report);
  return {};
}

Result<QuantisedMesh> place(const TetMesh& mesh, const QuantiseOptions& options,
                            const std::stop_token& stop, std::vector<Triangle> boundary) {
  if (Status checked = checkQuantiseOptions(options); !checked)
    return std::unexpected(checked.error());
  PointBox box;
  box.include(mesh.points);
  if (Status checked = checkBox(box); !checked) return std::unexpected(checked.error());

  QuantisedMesh out;
  out.report.requestedBits = options.positionBits;
  placePoints(mesh, box, stop, out);
  if (Status checked = checkWorse(mesh.tetrahedra.size(), box, out.report); !checked)
    return std::unexpected(checked.error());
  out.mesh.tetrahedra = mesh.tetrahedra;
  out.mesh.boundary =
      boundary.empty() ? boundaryOf(mesh.tetrahedra, StopFlag(stop).get()) : std::move(boundary);
  throwIfStopped(stop);
  if (Status placed = takeFields(mesh, options, stop, out); !placed)
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
