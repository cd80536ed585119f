#include "tests/bench/parts/rate_curves.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

#include "codec/log/log_writer.h"

namespace qtet::bench {
namespace {

constexpr std::array kRungs = {64.0, 16.0, 4.0, 1.0};

/// A mesh that nothing was fused in: its log is a base mesh alone.
FusionHistory withoutFusions(LatticeMesh mesh) {
  FusionHistory out;
  out.lattice = mesh.lattice;
  out.fields = std::move(mesh.fields);
  out.points = std::move(mesh.points);
  out.values = std::move(mesh.values);
  out.cells = std::move(mesh.tetrahedra);
  for (const Triangle& t : mesh.boundary) out.cells.push_back({t[0], t[1], t[2], kGhost});
  out.live.assign(out.cells.size(), 1);
  return out;
}

RatePoint pointOf(const ManifestLevel& level, double bytes) {
  return {bytes, level.level, level.error->boundaryMean(), level.error->fields[0].rms};
}

/// The point that is reached at `bytes`, nullptr before the first point.
const RatePoint* at(const RateCurve& curve, double bytes) {
  const auto next = std::ranges::upper_bound(curve, bytes, {}, &RatePoint::bytes);
  return next == curve.begin() ? nullptr : &*std::prev(next);
}

}  // namespace

Result<RateCurve> logCurve(const OpenedLog& log) {
  const std::vector<ManifestLevel>& levels = log.manifest.levels;
  RateCurve out;
  for (const ManifestLevel& level : levels) {
    if (!level.error || level.error->fields.empty())
      return fail(ErrorCode::kNotFound, "the log does not have the error of level " +
                                            std::to_string(level.level) +
                                            " for a field; make it with one and --measure all");
    const RatePoint point = pointOf(level, static_cast<double>(log.prefixBytes(level.level)));
    if (!out.empty() && out.back().bytes == point.bytes) out.pop_back();
    out.push_back(point);
  }
  return out;
}

Result<RateCurve> ladderCurve(const OpenedLog& log) {
  const std::vector<ManifestLevel>& levels = log.manifest.levels;
  RateCurve out;
  double bytes = 0;
  for (const double rung : kRungs) {
    const auto above = std::ranges::find_if(levels, [&](const ManifestLevel& level) {
      return level.tetrahedra > levels.back().tetrahedra / rung;
    });
    const ManifestLevel& level = above == levels.begin() ? *above : *std::prev(above);
    Result<LatticeMesh> mesh = meshAtLevel(log.file, level.level);
    if (!mesh) return std::unexpected(mesh.error());
    LogWriterOptions options;
    options.source = log.manifest.source;
    options.generator = log.manifest.generator;
    const Result<EncodedLog> step = encodeLog(withoutFusions(std::move(*mesh)), options);
    if (!step) return std::unexpected(step.error());
    bytes += static_cast<double>(step->bytes.size());
    out.push_back(pointOf(level, bytes));
  }
  return out;
}

Comparison compare(const RateCurve& curve, const RateCurve& other, Measure measure) {
  std::vector<double> places;
  for (const RateCurve* c : {&curve, &other})
    for (const RatePoint& point : *c) places.push_back(point.bytes);
  std::ranges::sort(places);
  places.erase(std::ranges::unique(places).begin(), places.end());

  Comparison out;
  out.places = places.size();
  for (const double bytes : places) {
    const RatePoint *mine = at(curve, bytes), *theirs = at(other, bytes);
    if (!theirs) continue;
    if (!mine || mine->*measure > theirs->*measure) ++out.above;
    if (!mine || !(theirs->*measure > 0)) continue;
    if (const double ratio = mine->*measure / theirs->*measure; ratio > out.worst)
      out.worst = ratio, out.worstBytes = bytes;
  }
  return out;
}

RatePoint firstWithin(const RateCurve& curve, double boundary, double field) {
  const auto found = std::ranges::find_if(
      curve, [&](const RatePoint& p) { return p.boundary <= boundary && p.field <= field; });
  assert(found != curve.end());
  return *found;
}

ErrorCurve plotted(const std::string& name, const RateCurve& curve, Measure measure) {
  ErrorCurve out{name, false, {}};
  for (const RatePoint& point : curve) out.points.push_back({point.bytes, point.*measure});
  return out;
}

}  // namespace qtet::bench
