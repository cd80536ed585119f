#include "tests/support/plain_error.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <span>
#include <vector>

#include "tests/support/exact_geometry.h"

namespace qtet::testing {
namespace {

using Place = std::array<double, 3>;

Place operator+(const Place& a, const Place& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
Place operator-(const Place& a, const Place& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Place operator*(double s, const Place& a) { return {s * a[0], s * a[1], s * a[2]}; }
double along(const Place& a, const Place& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Place across(const Place& a, const Place& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
double lengthOf(const Place& a) { return std::sqrt(along(a, a)); }

Place placeOf(const LatticeMesh& mesh, VertexId v) {
  const LatticePoint& p = mesh.points[v];
  return {static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2])};
}

/// A place in a cell or a triangle: the weights of its corners.
template <std::size_t N>
struct Spot {
  std::array<VertexId, N> corners{};
  std::array<double, N> weights{};

  [[nodiscard]] Place placeIn(const LatticeMesh& mesh) const {
    Place out{};
    for (std::size_t i = 0; i < N; ++i) out = out + weights[i] * placeOf(mesh, corners[i]);
    return out;
  }
};

/// All point fields there, over their ranges, one component after the other.
template <std::size_t N>
std::vector<double> valuesAt(const LatticeMesh& mesh, const Spot<N>& spot) {
  std::vector<double> out;
  for (std::size_t f = 0; f < mesh.fields.size(); ++f) {
    const FieldInfo& info = mesh.fields[f];
    if (isCellField(info)) continue;
    for (std::size_t c = 0; c < info.components; ++c) {
      double sum = 0;
      for (std::size_t i = 0; i < N; ++i)
        sum += spot.weights[i] * mesh.values[f][spot.corners[i] * info.components + c];
      out.push_back(sum * info.step / (info.range[1] - info.range[0]));
    }
  }
  return out;
}

double sixVolumes(const Place& a, const Place& b, const Place& c, const Place& d) {
  return along(across(b - a, c - a), d - a);
}

double measureOf(const LatticeMesh& mesh, const Tetrahedron& t) {
  return sixVolumes(placeOf(mesh, t[0]), placeOf(mesh, t[1]), placeOf(mesh, t[2]),
                    placeOf(mesh, t[3]));
}
double measureOf(const LatticeMesh& mesh, const Triangle& t) {
  const Place a = placeOf(mesh, t[0]);
  return lengthOf(across(placeOf(mesh, t[1]) - a, placeOf(mesh, t[2]) - a));
}

/// Evenly over the volume of the cells, or over the area of the triangles.
template <std::size_t N>
std::vector<Spot<N>> spread(const LatticeMesh& mesh,
                            const std::vector<std::array<VertexId, N>>& cells, std::size_t count) {
  std::mt19937 random(20261121);
  const auto fraction = [&] { return (static_cast<double>(random()) + 0.5) / 0x1p32; };
  double total = 0;
  for (const auto& cell : cells) total += std::max(measureOf(mesh, cell), 0.0);
  std::vector<Spot<N>> out;
  double before = 0;
  for (const auto& cell : cells) {
    before += std::max(measureOf(mesh, cell), 0.0);
    while (out.size() < count &&
           (static_cast<double>(out.size()) + 0.5) * total <= before * static_cast<double>(count)) {
      // lengths of the pieces that N - 1 cuts make of 1
      std::array<double, N + 1> cuts{};
      for (std::size_t i = 1; i < N; ++i) cuts[i] = fraction();
      cuts[N] = 1;
      std::ranges::sort(cuts);
      Spot<N> spot{cell, {}};
      for (std::size_t i = 0; i < N; ++i) spot.weights[i] = cuts[i + 1] - cuts[i];
      out.push_back(spot);
    }
  }
  return out;
}

/// The boundary of a mesh, asked for the nearest point.
class Surface {
 public:
  explicit Surface(const LatticeMesh& mesh) : mesh_(mesh) {
    for (const Triangle& t : mesh.boundary) {
      Ball ball{(1.0 / 3) * (placeOf(mesh, t[0]) + placeOf(mesh, t[1]) + placeOf(mesh, t[2])), 0};
      for (const VertexId v : t)
        ball.radius = std::max(ball.radius, lengthOf(placeOf(mesh, v) - ball.centre));
      balls_.push_back(ball);
    }
  }

  struct Nearest {
    Spot<3> spot;
    double distance = std::numeric_limits<double>::infinity();
  };
  [[nodiscard]] Nearest nearest(const Place& p) const {
    Nearest best;
    for (std::size_t i = 0; i < balls_.size(); ++i) {
      const Place d = p - balls_[i].centre;
      const double reach = best.distance + balls_[i].radius;
      if (along(d, d) > reach * reach) continue;
      const Nearest here = nearestOf(mesh_.boundary[i], p);
      if (here.distance < best.distance) best = here;
    }
    return best;
  }

 private:
  struct Ball {
    Place centre;
    double radius;
  };

  [[nodiscard]] Nearest nearestOf(const Triangle& t, const Place& p) const {
    const std::array<Place, 3> at{placeOf(mesh_, t[0]), placeOf(mesh_, t[1]), placeOf(mesh_, t[2])};
    const Place normal = across(at[1] - at[0], at[2] - at[0]);
    const double squared = along(normal, normal);
    std::array<double, 3> weights{};
    bool isOver = squared > 0;
    for (std::size_t i = 0; i < 3 && isOver; ++i) {
      const Place &from = at[(i + 1) % 3], &to = at[(i + 2) % 3];
      weights[i] = along(across(to - from, p - from), normal) / squared;
      isOver = weights[i] >= 0;
    }
    if (isOver) return {{t, weights}, std::abs(along(p - at[0], normal)) / std::sqrt(squared)};
    Nearest best;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t j = (i + 1) % 3;
      const Place edge = at[j] - at[i];
      const double length = along(edge, edge);
      const double part = length > 0 ? std::clamp(along(p - at[i], edge) / length, 0.0, 1.0) : 0;
      const double distance = lengthOf(p - (at[i] + part * edge));
      if (distance >= best.distance) continue;
      best = {{t, {}}, distance};
      best.spot.weights[i] = 1 - part, best.spot.weights[j] += part;
    }
    return best;
  }

  const LatticeMesh& mesh_;
  std::vector<Ball> balls_;
};

Box boxOf(const Place& p) {
  Box out;
  for (std::size_t a = 0; a < 3; ++a)
    out.low[a] = static_cast<std::int64_t>(std::floor(p[a])),
    out.high[a] = static_cast<std::int64_t>(std::ceil(p[a]));
  return out;
}

Box boxOf(const LatticeMesh& mesh, const Tetrahedron& cell) {
  std::array<Point, 4> corners{};
  for (std::size_t i = 0; i < 4; ++i) std::ranges::copy(mesh.points[cell[i]], corners[i].begin());
  return testing::boxOf(corners);
}

/// Where each place lies in the level: the cell that it is deepest in; `isIn` false outside of all.
struct Found {
  Spot<4> spot;
  double depth = -1e-9;
  bool isIn = false;
};
std::vector<Found> findAll(const LatticeMesh& level, std::span<const Place> places) {
  std::vector<Box> here, cells;
  for (const Place& p : places) here.push_back(boxOf(p));
  for (const Tetrahedron& cell : level.tetrahedra) cells.push_back(boxOf(level, cell));
  std::vector<Found> out(places.size());
  forEachBoxPair(here, cells, [&](std::size_t i, std::size_t j) {
    const Tetrahedron& cell = level.tetrahedra[j];
    const double whole = measureOf(level, cell);
    if (!(whole > 0)) return;
    Spot<4> spot{cell, {}};
    for (std::size_t corner = 0; corner < 4; ++corner) {
      std::array<Place, 4> at{};
      for (std::size_t k = 0; k < 4; ++k) at[k] = k == corner ? places[i] : placeOf(level, cell[k]);
      spot.weights[corner] = sixVolumes(at[0], at[1], at[2], at[3]) / whole;
    }
    const double depth = *std::ranges::min_element(spot.weights);
    if (depth > out[i].depth) out[i] = {spot, depth, true};
  });
  return out;
}

/// Root mean square of all differences that are added.
class MeanSquare {
 public:
  void add(const std::vector<double>& a, const std::vector<double>& b) {
    for (std::size_t i = 0; i < a.size(); ++i) sum_ += (a[i] - b[i]) * (a[i] - b[i]), ++count_;
  }
  [[nodiscard]] double root() const { return std::sqrt(sum_ / static_cast<double>(count_)); }

 private:
  double sum_ = 0;
  std::size_t count_ = 0;
};

double fieldError(const LatticeMesh& original, const LatticeMesh& level, const Surface& surface,
                  std::size_t samples) {
  const std::vector<Spot<4>> spots = spread(original, original.tetrahedra, samples);
  std::vector<Place> places;
  for (const Spot<4>& spot : spots) places.push_back(spot.placeIn(original));
  const std::vector<Found> found = findAll(level, places);
  MeanSquare error;
  for (std::size_t i = 0; i < spots.size(); ++i)
    error.add(valuesAt(original, spots[i]), found[i].isIn
                                                ? valuesAt(level, found[i].spot)
                                                : valuesAt(level, surface.nearest(places[i]).spot));
  return error.root();
}

double wallError(const LatticeMesh& original, const LatticeMesh& level, const Surface& surface,
                 std::size_t samples) {
  MeanSquare error;
  for (const Spot<3>& spot : spread(original, original.boundary, samples))
    error.add(valuesAt(original, spot),
              valuesAt(level, surface.nearest(spot.placeIn(original)).spot));
  return error.root();
}

double farthest(const LatticeMesh& from, const Surface& to, std::size_t samples) {
  std::vector<char> isOnBoundary(from.points.size(), 0);
  for (const Triangle& t : from.boundary)
    for (const VertexId v : t) isOnBoundary[v] = 1;
  double most = 0;
  for (VertexId v = 0; v < from.points.size(); ++v)
    if (isOnBoundary[v] != 0) most = std::max(most, to.nearest(placeOf(from, v)).distance);
  for (const Spot<3>& spot : spread(from, from.boundary, samples))
    most = std::max(most, to.nearest(spot.placeIn(from)).distance);
  return most;
}

double diagonalOf(const LatticeMesh& mesh) {
  Place extent{};
  for (std::size_t a = 0; a < 3; ++a) {
    const auto [low, high] =
        std::ranges::minmax(mesh.points, {}, [a](const LatticePoint& p) { return p[a]; });
    extent[a] = high[a] - low[a];
  }
  return lengthOf(extent);
}

}  // namespace

PlainError plainError(const LatticeMesh& original, const LatticeMesh& level, std::size_t samples) {
  const Surface before(original), after(level);
  return {fieldError(original, level, after, samples), wallError(original, level, after, samples),
          std::max(farthest(original, after, samples), farthest(level, before, samples)) /
              diagonalOf(original)};
}

double angleAt(const LatticeMesh& mesh, double fraction) {
  std::vector<double> angles;
  for (const Tetrahedron& cell : mesh.tetrahedra)
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t j = 0; j < i; ++j) {
        const Place from = placeOf(mesh, cell[i]), edge = placeOf(mesh, cell[j]) - from;
        std::array<Place, 2> out{};  // of the other two corners, square to the edge
        std::size_t n = 0;
        for (std::size_t k = 0; k < 4; ++k) {
          if (k == i || k == j) continue;
          const Place d = placeOf(mesh, cell[k]) - from;
          out[n++] = along(edge, edge) * d - along(d, edge) * edge;
        }
        const double cosine = along(out[0], out[1]) / (lengthOf(out[0]) * lengthOf(out[1]));
        angles.push_back(std::acos(std::clamp(cosine, -1.0, 1.0)) * 180 / std::numbers::pi);
      }
  const auto at = angles.begin() +
                  static_cast<std::ptrdiff_t>(fraction * static_cast<double>(angles.size() - 1));
  std::nth_element(angles.begin(), at, angles.end());
  return *at;
}

}  // namespace qtet::testing
