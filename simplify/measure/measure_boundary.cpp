#include "simplify/measure/measure_boundary.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "simplify/mesh/workers.h"

namespace qtet {
namespace {

/// Parts of a triangle's edge in the grid that is searched for the farthest point: two give corners
/// and middles; with sixteen a grid is as fine as needed, since the distance changes by less than
/// the step.
constexpr double kFewestParts = 2, kMaxParts = 16;

}  // namespace

void followFusion(const MeasuredMesh& mesh, const Fusion& fusion, const Vector3& at,
                  NearestTriangle& nearest) {
  nearest = {};
  for (const std::uint32_t cell : mesh.affected(fusion))
    if (mesh.isGhost(cell)) mesh.boundaryTree().tryTriangle(at, cell, nearest);
}

BoundaryMeter::BoundaryMeter(const MeasuredMesh& mesh, const BoundaryOptions& options)
    : mesh_(mesh), options_(options) {
  assert(mesh.level() == mesh.history().levels);
  const FusionHistory& history = mesh.history();
  const auto onIt = [](const Vector3& at, std::uint32_t ghost) {
    return Followed{at, {ghost, {0, {}}}};
  };
  for (const Sample& s : samplesOnSurface(history.points, history.cells, mesh.originalBoundary(),
                                          options.samples, options.seed))
    samples_.push_back(onIt(s.at, s.cell));
  triangleBounds_.assign(mesh.originalBoundary().size(), 0);
  std::vector<std::uint8_t> met(history.points.size(), 0);
  for (const std::uint32_t ghost : mesh.originalBoundary())
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const VertexId v = history.cells[ghost][corner];
      if (!met[v]) vertices_.push_back(onIt(toVector(history.points[v]), ghost));
      met[v] = 1;
    }
}

void BoundaryMeter::follow() {
  const auto followAll = [&](std::vector<Followed>& places, bool searching) {
    options_.workers->forRuns(places.size(), kPlacesPerRun,
                              [&, searching](std::size_t begin, std::size_t end) {
                                for (std::size_t i = begin; i < end; ++i) {
                                  Followed& place = places[i];
                                  const Fusion* fusion = mesh_.fusionOf(place.nearest.triangle);
                                  if (fusion == nullptr) continue;
                                  followFusion(mesh_, *fusion, place.at, place.nearest);
                                  if (searching)
                                    mesh_.boundaryTree().nearest(place.at, place.nearest);
                                }
                              });
  };
  followAll(samples_, true);
  followAll(vertices_, false);
}

// The vertices with the largest bounds are searched exactly until no bound is above what was found.
double BoundaryMeter::farthestVertex(double squared) {
  std::vector<std::uint32_t> candidates;
  for (std::uint32_t i = 0; i < vertices_.size(); ++i)
    if (vertices_[i].nearest.point.squared > squared) candidates.push_back(i);
  const auto isNearer = [&](std::uint32_t a, std::uint32_t b) {
    const double da = vertices_[a].nearest.point.squared, db = vertices_[b].nearest.point.squared;
    return da < db || (da == db && a > b);
  };
  std::ranges::make_heap(candidates, isNearer);
  while (!candidates.empty()) {
    Followed& farthest = vertices_[candidates.front()];
    if (farthest.nearest.point.squared <= squared) break;
    std::ranges::pop_heap(candidates, isNearer);
    candidates.pop_back();
    mesh_.boundaryTree().nearest(farthest.at, farthest.nearest, squared);
    squared = std::max(squared, farthest.nearest.point.squared);
  }
  return squared;
}

OneSidedDistance BoundaryMeter::toLevel() {
  double sum = 0, farthest = 0;
  for (const Followed& sample : samples_) {
    sum += std::sqrt(sample.nearest.point.squared);
    farthest = std::max(farthest, sample.nearest.point.squared);
  }
  const double mean = samples_.empty() ? 0 : sum / static_cast<double>(samples_.size());
  return {mean / mesh_.diagonal(), std::sqrt(farthestVertex(farthest)) / mesh_.diagonal()};
}

double BoundaryMeter::farthestOnTriangle(std::uint32_t ghost, int parts, double enough) const {
  const FusionHistory& history = mesh_.history();
  std::array<Vector3, 3> corners;
  for (std::size_t c = 0; c < 3; ++c)
    corners[c] = toVector(history.points[history.cells[ghost][c]]);
  std::uint32_t guess = mesh_.originalTriangle(ghost);  // it lay there once
  const auto squaredAt = [&](const Vector3& at, double limit) {
    NearestTriangle nearest;
    mesh_.originalTree().tryTriangle(at, guess, nearest);
    mesh_.originalTree().nearest(at, nearest, limit);
    guess = nearest.triangle;
    return nearest.point.squared;
  };
  const Vector3 middle = blend(corners, {1 / 3.0, 1 / 3.0, 1 / 3.0});
  double radius = 0;
  for (const Vector3& corner : corners)
    radius = std::max(radius, dot(corner - middle, corner - middle));
  radius = std::sqrt(radius);
  // No point of the triangle is further than its middle by more than the radius: small triangles
  // near the original are done with here.
  const double spare = std::sqrt(enough) - radius;
  double farthest = squaredAt(middle, spare > 0 ? spare * spare : enough);
  if (spare > 0 && farthest <= spare * spare) return enough;
  for (int i = 0; i <= parts; ++i)
    for (int j = 0; i + j <= parts; ++j) {
      const double s = static_cast<double>(i) / parts, t = static_cast<double>(j) / parts;
      farthest = std::max(farthest,
                          squaredAt(blend(corners, {1 - s - t, s, t}), std::max(enough, farthest)));
    }
  return farthest;
}

// What was found for a triangle, an upper bound, holds until the triangle changes; it need not be
// exact while it is not above the maximum.
double BoundaryMeter::farthestOfTriangles(double squared) {
  const std::vector<std::uint32_t>& boundary = mesh_.boundary();
  const double affordable =
      std::sqrt(static_cast<double>(options_.gridPoints) / static_cast<double>(boundary.size()));
  const int parts = static_cast<int>(std::clamp(affordable, kFewestParts, kMaxParts));
  options_.workers->forRuns(
      boundary.size(), kPlacesPerRun, [&](std::size_t begin, std::size_t end) {
        double farthest = squared;
        for (std::size_t i = begin; i < end; ++i) {
          double& bound = triangleBounds_[mesh_.originalTriangle(boundary[i])];
          if (mesh_.fusionOf(boundary[i]) == nullptr && bound <= farthest) continue;
          bound = farthestOnTriangle(boundary[i], parts, farthest);
          farthest = std::max(farthest, bound);
        }
      });
  for (const std::uint32_t ghost : boundary)
    squared = std::max(squared, triangleBounds_[mesh_.originalTriangle(ghost)]);
  return squared;
}

OneSidedDistance BoundaryMeter::toOriginal() {
  const FusionHistory& history = mesh_.history();
  const std::vector<Sample> samples =
      samplesOnSurface(history.points, history.cells, mesh_.boundary(), options_.levelSamples,
                       options_.seed + mesh_.level() + 1);
  std::vector<double> squared(samples.size());
  options_.workers->forRuns(samples.size(), kPlacesPerRun, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (mesh_.isOriginal(samples[i].cell)) continue;
      NearestTriangle nearest;
      mesh_.originalTree().tryTriangle(samples[i].at, mesh_.originalTriangle(samples[i].cell),
                                       nearest);
      mesh_.originalTree().nearest(samples[i].at, nearest);
      squared[i] = nearest.point.squared;
    }
  });
  double sum = 0, farthest = 0;
  for (const double s : squared) {
    sum += std::sqrt(s);
    farthest = std::max(farthest, s);
  }
  const double mean = samples.empty() ? 0 : sum / static_cast<double>(samples.size());
  return {mean / mesh_.diagonal(), std::sqrt(farthestOfTriangles(farthest)) / mesh_.diagonal()};
}

}  // namespace qtet
