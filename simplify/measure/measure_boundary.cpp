#include "simplify/measure/measure_boundary.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>

#include "simplify/mesh/workers.h"

namespace qtet {
namespace {

/// Squared shares of the diagonal that are no distance: what doubles make of none.
constexpr double kNothing = 0x1p-82;
/// Triangles that a thread takes at a time, and those that are bounded first: a maximum found early
/// spares the others.
constexpr std::size_t kTrianglesPerRun = 64, kFirstTriangles = 128;
/// Fusions that a thread takes at a time.
constexpr std::size_t kFusionsPerRun = 64;

}  // namespace

void followFusion(const MeasuredMesh& mesh, const Fusion& fusion, const Vector3& at,
                  NearestTriangle& nearest) {
  nearest = {};
  for (const std::uint32_t cell : mesh.affected(fusion))
    if (mesh.isGhost(cell)) mesh.boundaryTree().tryTriangle(at, cell, nearest);
}

BoundaryMeter::BoundaryMeter(const MeasuredMesh& mesh, const BoundaryOptions& options)
    : mesh_(mesh), options_(options) {
  assert(mesh.level() == mesh.history().levels && options.workers != nullptr);
  const FusionHistory& history = mesh.history();
  const auto onIt = [](const Vector3& at, std::uint32_t ghost) {
    return Followed{at, {ghost, {0, {}}}};
  };
  if (options.before != nullptr) {
    for (const Vector3& at : options.before->surface) samples_.push_back({at, {}, false});
  } else {
    for (const ErrorSample& s : samplesOnSurface(
             history.points, history.cells, mesh.originalBoundary(), options.samples, options.seed))
      samples_.push_back(onIt(s.at, s.cell));
  }
  triangleBounds_.assign(mesh.originalBoundary().size(), 0);
  for (const std::uint32_t ghost : mesh.originalBoundary())
    triangles_.push_back({ghost, 0, std::numeric_limits<double>::infinity(), {}});
}

double BoundaryMeter::nothing() const { return kNothing * mesh_.diagonal() * mesh_.diagonal(); }

void BoundaryMeter::follow() {
  options_.workers->forRuns(samples_.size(), kPlacesPerRun,
                            [&](std::size_t begin, std::size_t end) {
                              for (std::size_t i = begin; i < end; ++i) {
                                auto& [at, nearest, isNear] = samples_[i];
                                const Fusion* fusion = mesh_.fusionOf(nearest.triangle);
                                if (fusion == nullptr) continue;
                                followFusion(mesh_, *fusion, at, nearest);
                                isNear = false;
                              }
                            });
  options_.workers->forRuns(triangles_.size(), kPlacesPerRun,
                            [&](std::size_t begin, std::size_t end) {
                              for (std::size_t i = begin; i < end; ++i)
                                follow(static_cast<std::uint32_t>(i));
                            });
  const std::span<const Fusion> step = mesh_.step();
  options_.workers->forRuns(step.size(), kFusionsPerRun, [&](std::size_t begin, std::size_t end) {
    for (const Fusion& fusion : step.subspan(begin, end - begin)) followTriangles(fusion);
  });
}

// A triangle keeps an edge, and its third corner becomes the fused vertex. The distance to the
// triangle as it was is convex and 0 along the edge, so it is the largest at that vertex.
void BoundaryMeter::followTriangles(const Fusion& fusion) {
  const FusionHistory& history = mesh_.history();
  const Vector3 fused = toVector(history.points[fusion.fused]);
  for (std::size_t i = fusion.firstAffected; i < fusion.firstAffected + fusion.affectedCount; ++i) {
    const std::uint32_t ghost = history.affectedCells[i];
    if (!mesh_.isGhost(ghost)) continue;
    Tetrahedron was = history.cells[ghost];
    std::ranges::replace(was, fusion.fused, fusion.prey[history.affectedLabels[i]]);
    const Corners corners{toVector(history.points[was[0]]), toVector(history.points[was[1]]),
                          toVector(history.points[was[2]])};
    assert(history.affectedLabels[i] < fusion.k);
    double& bound = triangleBounds_[mesh_.originalTriangle(ghost)];
    const double distance = std::sqrt(bound) + std::sqrt(nearestOnTriangle(fused, corners).squared);
    bound = distance * distance;
  }
}

void BoundaryMeter::search() {
  options_.workers->forRuns(samples_.size(), kPlacesPerRun,
                            [&](std::size_t begin, std::size_t end) {
                              for (std::size_t i = begin; i < end; ++i)
                                if (!std::exchange(samples_[i].isNear, true))
                                  mesh_.boundaryTree().nearest(samples_[i].at, samples_[i].nearest);
                            });
  options_.workers->forRuns(
      triangles_.size(), kPlacesPerRun, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
          if (std::isinf(triangles_[i].bound))
            triangles_[i].bound =
                farthestCorner(mesh_.originalTree().corners(static_cast<std::uint32_t>(i)),
                               mesh_.boundaryTree().corners(triangles_[i].near));
      });
}

void BoundaryMeter::follow(std::uint32_t triangle) {
  FollowedTriangle& followed = triangles_[triangle];
  for (std::size_t i = 0; i < followed.cover.count; ++i)
    if (mesh_.fusionOf(followed.cover.triangles[i]) != nullptr) followed.cover.isAll = false;
  if (!followed.cover.isAll) followed.coveredBound = std::numeric_limits<double>::infinity();
  const Fusion* fusion = mesh_.fusionOf(followed.near);
  if (fusion == nullptr) return;
  const auto [a, b, c] = mesh_.originalTree().corners(triangle);
  NearestTriangle nearest;
  followFusion(mesh_, *fusion, 1.0 / 3 * (a + b + c), nearest);
  assert(mesh_.isGhost(nearest.triangle) && mesh_.history().live[nearest.triangle]);
  followed.near = nearest.triangle;
  followed.bound = std::numeric_limits<double>::infinity();
}

BoundaryMeter::Maximum BoundaryMeter::farthestOf(std::span<const std::uint32_t> triangles,
                                                 double squared) {
  std::vector<Maximum> of(triangles.size());
  options_.workers->forRuns(
      triangles.size(), kTrianglesPerRun, [&](std::size_t begin, std::size_t end) {
        double farthest = squared;
        for (std::size_t i = begin; i < end; ++i) {
          FollowedTriangle& followed = triangles_[triangles[i]];
          of[i].bound = followed.best();
          if (followed.best() <= withTolerance(farthest)) continue;
          const Corners corners = mesh_.originalTree().corners(triangles[i]);
          const FarthestPoint point =
              farthestPoint(mesh_.boundaryTree(), corners, followed.near, farthest);
          assert(point.found <= point.bound);
          of[i] = {point.found, point.bound};
          farthest = std::max(farthest, point.found);
          const double bound = farthestCorner(corners, mesh_.boundaryTree().corners(point.nearest));
          if (bound < followed.bound) followed.near = point.nearest, followed.bound = bound;
          followed.coveredBound = point.bound;
          followed.cover = point.cover;
        }
      });
  Maximum out{squared, 0};
  for (const Maximum& m : of) out = {std::max(out.found, m.found), std::max(out.bound, m.bound)};
  return out;
}

// A bound by one triangle of the level is enough for most; the others are cut into pieces, the
// farthest first.
double BoundaryMeter::boundToLevel(double squared) {
  squared = std::max(squared, nothing());
  double bound = squared;
  std::vector<std::uint32_t> far;
  for (std::uint32_t i = 0; i < triangles_.size(); ++i)
    if (triangles_[i].best() > withTolerance(squared)) {
      far.push_back(i);
    } else {
      bound = std::max(bound, triangles_[i].best());
    }
  const std::size_t first = std::min(kFirstTriangles, far.size());
  const auto rest = far.begin() + static_cast<std::ptrdiff_t>(first);
  std::ranges::partial_sort(far, rest, std::less{},
                            [&](std::uint32_t i) { return std::pair(-triangles_[i].best(), i); });
  std::sort(rest, far.end());  // neighbours in the mesh are neighbours in memory
  const std::span<const std::uint32_t> all(far);
  const Maximum farthest = farthestOf(all.first(first), squared);
  const Maximum others = farthestOf(all.subspan(first), farthest.found);
  return std::max({bound, others.found, farthest.bound, others.bound});
}

OneSidedDistance BoundaryMeter::toLevel() {
  double sum = 0, farthest = 0;
  for (const Followed& sample : samples_) {
    sum += std::sqrt(sample.nearest.point.squared + options_.squaredRounding);
    farthest = std::max(farthest, sample.nearest.point.squared);
  }
  const double mean = samples_.empty() ? 0 : sum / static_cast<double>(samples_.size());
  // some point of the finest level's boundary is as far as a place of the original, less its way
  const double before = options_.before != nullptr ? options_.before->toMesh.max : 0;
  const double found = std::max(std::sqrt(farthest) - before, 0.0);
  return {mean / mesh_.diagonal(),
          (std::sqrt(boundToLevel(found * found)) + before) / mesh_.diagonal()};
}

// A triangle's bound need not be sharp while it is not above the maximum.
double BoundaryMeter::boundToOriginal(double squared) {
  squared = std::max(squared, nothing());
  const std::vector<std::uint32_t>& boundary = mesh_.boundary();
  options_.workers->forRuns(
      boundary.size(), kPlacesPerRun, [&](std::size_t begin, std::size_t end) {
        double farthest = squared;
        for (std::size_t i = begin; i < end; ++i) {
          const std::uint32_t was = mesh_.originalTriangle(boundary[i]);
          double& bound = triangleBounds_[was];
          if (bound <= withTolerance(farthest)) continue;
          const FarthestPoint point = farthestPoint(
              mesh_.originalTree(), mesh_.boundaryTree().corners(boundary[i]), was, farthest);
          assert(point.found <= point.bound);
          bound = point.bound;
          farthest = std::max(farthest, point.found);
        }
      });
  for (const std::uint32_t ghost : boundary)
    squared = std::max(squared, triangleBounds_[mesh_.originalTriangle(ghost)]);
  return squared;
}

OneSidedDistance BoundaryMeter::toOriginal() {
  const FusionHistory& history = mesh_.history();
  const std::vector<ErrorSample> samples =
      samplesOnSurface(history.points, history.cells, mesh_.boundary(), options_.levelSamples,
                       options_.seed + mesh_.level() + 1);
  std::vector<double> squared(samples.size());
  options_.workers->forRuns(samples.size(), kPlacesPerRun, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      assert(mesh_.isGhost(samples[i].cell) && mesh_.history().live[samples[i].cell]);
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
    sum += std::sqrt(s + options_.squaredRounding);
    farthest = std::max(farthest, s);
  }
  const double mean = samples.empty() ? 0 : sum / static_cast<double>(samples.size());
  const OneSidedDistance before =
      options_.before != nullptr ? options_.before->toOriginal : OneSidedDistance{};
  return {(mean + before.mean) / mesh_.diagonal(),
          (std::sqrt(boundToOriginal(farthest)) + before.max) / mesh_.diagonal()};
}

}  // namespace qtet
