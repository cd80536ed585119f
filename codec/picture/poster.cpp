#include "codec/picture/poster.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "codec/mesh/boundary.h"
#include "codec/picture/canvas.h"
#include "codec/picture/field_look.h"
#include "codec/picture/first_camera.h"
#include "codec/picture/first_warp.h"
#include "codec/picture/webp.h"

namespace qtet {
namespace {

/// Tried in this order at each size.
constexpr std::array<int, 4> kQualities = {75, 60, 45, 30};
/// The next size's pixels along a side: at most and at least this share.
constexpr double kSlightlySmaller = 0.8, kMuchSmaller = 0.5;
/// A little above the eye, in the camera's view.
constexpr Vector kLight = {0.25, 0.45, 1};
/// The shares of the light: on every face, from the lamp, from the sky.
constexpr double kAmbient = 0.68, kLamp = 0.18, kSky = 0.14;
/// The inside of a surface that is cut open.
constexpr Colour kInside = {0.24, 0.26, 0.30};
constexpr double kInsideShare = 0.55;
/// The side that a cut takes away faces the eye.
constexpr Vector kFirstSides = {1, -1, 1};

/// The part above it is cut away.
struct Plane {
  Vector normal{};
  double offset = 0;
  [[nodiscard]] double height(const Vector& p) const { return dot(normal, p) - offset; }
};

struct Point {
  Vector place;  ///< on the lattice
  double value;
};
using Polygon = std::vector<Point>;

Vector placeOf(const LatticePoint& p) {
  return {static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2])};
}

Point between(const Point& a, const Point& b, double t) {
  Point out{{}, a.value + t * (b.value - a.value)};
  for (std::size_t axis = 0; axis < 3; ++axis)
    out.place[axis] = a.place[axis] + t * (b.place[axis] - a.place[axis]);
  return out;
}

/// The part of a convex polygon where `height` is not above 0.
template <class Height>
Polygon clipped(const Polygon& polygon, Height height) {
  Polygon out;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Point &from = polygon[i], &to = polygon[(i + 1) % polygon.size()];
    const double before = height(from.place), after = height(to.place);
    if (before <= 0) out.push_back(from);
    if ((before <= 0) != (after <= 0)) out.push_back(between(from, to, before / (before - after)));
  }
  return out;
}

/// The middle of the extent along the axis, between two lattice planes, so that no vertex lies on
/// the cut.
std::optional<Plane> openingPlane(const LatticeMesh& mesh, const Manifest& manifest) {
  if (!manifest.opening || !manifest.opening->cut) return std::nullopt;
  const std::size_t axis = *manifest.opening->cut;
  const Bounds bounds = boundsOf(mesh);
  Plane out;
  out.normal[axis] = kFirstSides[axis];
  const double a = out.normal[axis] * bounds.low[axis], b = out.normal[axis] * bounds.high[axis];
  out.offset = std::floor(std::min(a, b) + (std::max(a, b) - std::min(a, b)) / 2) + 0.5;
  return out;
}

/// The section of a cell by a plane, in order round its middle; empty if they do not meet.
Polygon sectionOf(const std::array<Point, 4>& corners, const Plane& plane) {
  std::vector<std::size_t> above, below;
  for (std::size_t i = 0; i < 4; ++i)
    (plane.height(corners[i].place) >= 0 ? above : below).push_back(i);
  const auto cut = [&](std::size_t i, std::size_t j) {
    const double from = plane.height(corners[i].place), to = plane.height(corners[j].place);
    return between(corners[i], corners[j], from / (from - to));
  };
  if (above.size() == 2)
    return {cut(above[0], below[0]), cut(above[0], below[1]), cut(above[1], below[1]),
            cut(above[1], below[0])};
  Polygon out;
  for (const std::size_t i : above)
    for (const std::size_t j : below) out.push_back(cut(i, j));
  return out;
}

bool showsLabel(const Manifest& manifest) {
  const std::vector<std::uint32_t> fields = posterFields(manifest);
  return !fields.empty() && labelNamesOf(manifest, fields.front()) != nullptr;
}

class PosterArtist {
 public:
  PosterArtist(const LatticeMesh& mesh, const Manifest& manifest, const std::optional<Plane>& plane)
      : mesh_(mesh),
        camera_(mesh, manifest.focus),
        look_(mesh, 0, showsLabel(manifest)),
        plane_(plane) {
    if (look_.ofCells()) boundaryCells_ = cellsOfBoundary();
  }

  /// The larger side takes `pixels`.
  [[nodiscard]] std::pair<int, int> size(int pixels) const {
    const auto [width, height] = camera_.halfExtent();
    const double larger = std::max(width, height);
    const auto side = [&](double extent) {
      return std::max(1, static_cast<int>(std::floor(pixels * extent / larger + 0.5)));
    };
    return {side(width), side(height)};
  }

  [[nodiscard]] Bytes draw(int width, int height) const {
    Canvas canvas(width, height, camera_.halfExtent());
    for (std::size_t t = 0; t < mesh_.boundary.size(); ++t) drawFace(canvas, t);
    if (plane_)
      for (std::size_t cell = 0; cell < mesh_.tetrahedra.size(); ++cell) drawSection(canvas, cell);
    if (camera_.showsPart()) canvas.fade();
    return canvas.pixels();
  }

 private:
  [[nodiscard]] Point point(VertexId v, double value) const {
    return {placeOf(mesh_.points[v]), value};
  }
  [[nodiscard]] double valueAt(VertexId v, std::size_t cell) const {
    return look_.at(look_.ofCells() ? cell : v);
  }

  /// The cell of each boundary triangle.
  [[nodiscard]] std::vector<CellId> cellsOfBoundary() const {
    std::vector<std::pair<Triangle, CellId>> faces;
    for (CellId cell = 0; cell < mesh_.tetrahedra.size(); ++cell)
      for (int opposite = 0; opposite < 4; ++opposite) {
        Triangle face = cellFace(mesh_.tetrahedra[cell], opposite);
        std::ranges::sort(face);
        faces.emplace_back(face, cell);
      }
    std::ranges::sort(faces);
    std::vector<CellId> out;
    for (Triangle face : mesh_.boundary) {
      std::ranges::sort(face);
      const auto at = std::ranges::lower_bound(faces, std::pair(face, CellId{0}));
      out.push_back(at != faces.end() && at->first == face ? at->second : 0);
    }
    return out;
  }

  void drawFace(Canvas& canvas, std::size_t t) const {
    const Triangle& triangle = mesh_.boundary[t];
    Polygon face;
    for (const VertexId v : triangle)
      face.push_back(point(v, valueAt(v, look_.ofCells() ? boundaryCells_[t] : 0)));
    std::array<Vector, 3> seen{};
    for (std::size_t k = 0; k < 3; ++k) seen[k] = camera_.view(face[k].place);
    // FirstCamera::view counts away from the eye: towards it is its negative.
    const auto side = [&](std::size_t k) {
      return Vector{seen[k][0] - seen[0][0], seen[k][1] - seen[0][1], seen[0][2] - seen[k][2]};
    };
    const Vector normal = unit(cross(side(1), side(2)));
    const bool isInside =
        normal[0] * seen[0][0] + normal[1] * seen[0][1] - normal[2] * seen[0][2] > 0;
    const double towards = isInside ? -1 : 1;  // the eye
    const double facing = std::max(towards * dot(normal, unit(kLight)), 0.0);
    const double sky = 0.5 + 0.5 * towards * normal[1];
    const double light = kAmbient + kLamp * facing + kSky * sky;
    if (plane_) face = clipped(face, [&](const Vector& p) { return plane_->height(p); });
    draw(canvas, face, [&](double value) {
      Colour colour = look_.colour(value);
      for (std::size_t c = 0; c < 3; ++c) {
        colour[c] *= light;
        if (isInside) colour[c] += kInsideShare * (kInside[c] - colour[c]);
      }
      return colour;
    });
  }

  void drawSection(Canvas& canvas, std::size_t cell) const {
    std::array<Point, 4> corners{};
    for (std::size_t i = 0; i < 4; ++i) {
      const VertexId v = mesh_.tetrahedra[cell][i];
      corners[i] = point(v, valueAt(v, cell));
    }
    draw(canvas, sectionOf(corners, *plane_), [&](double value) { return look_.colour(value); });
  }

  template <class Shade>
  void draw(Canvas& canvas, Polygon polygon, const Shade& shade) const {
    polygon =
        clipped(polygon, [&](const Vector& p) { return camera_.near() - camera_.view(p)[2]; });
    // A missing value leaves the whole face plain.
    const bool isPlain =
        std::ranges::any_of(polygon, [](const Point& p) { return std::isnan(p.value); });
    std::vector<Corner> corners;
    for (const auto& [place, value] : polygon)
      corners.push_back(
          {camera_.view(place), isPlain ? std::numeric_limits<double>::quiet_NaN() : value});
    canvas.draw(corners, shade);
  }

  const LatticeMesh& mesh_;
  const FirstCamera camera_;
  const FieldLook look_;
  const std::optional<Plane> plane_;
  std::vector<CellId> boundaryCells_;
};

}  // namespace

std::uint32_t posterLevel(const Manifest& manifest) {
  assert(!manifest.levels.empty());
  std::uint32_t out = 0;
  while (out + 1 < manifest.levels.size() &&
         manifest.levels[out + 1].chunk == manifest.levels[0].chunk)
    ++out;
  return out;
}

std::vector<std::uint32_t> posterFields(const Manifest& manifest) {
  if (manifest.fields.empty()) return {};
  const std::uint32_t colour = manifest.opening.value_or(Opening{}).field;
  const std::uint32_t motion = displacementOf(manifest).value_or(colour);
  if (motion == colour) return {colour};
  return {colour, motion};
}

Result<Bytes> posterWebp(const LatticeMesh& mesh, const Manifest& manifest) {
  if (mesh.boundary.empty())
    return fail(ErrorCode::kBadInput, "the mesh has no boundary triangle to draw");
  LatticeMesh moved = mesh;
  moveAsFirstShown(moved, manifest);
  const PosterArtist artist(moved, manifest, openingPlane(mesh, manifest));
  for (double pixels = kMaxPosterPixels; pixels >= kMinPosterPixels;) {
    const auto [width, height] = artist.size(static_cast<int>(pixels));
    const Bytes picture = artist.draw(width, height);
    std::size_t least = 0;
    for (const int quality : kQualities) {
      Result<Bytes> file = encodeWebp(picture, width, height, quality);
      if (!file || file->size() <= kMaxPosterBytes) return file;
      least = file->size();
    }
    pixels *=
        std::clamp(std::sqrt(static_cast<double>(kMaxPosterBytes) / static_cast<double>(least)),
                   kMuchSmaller, kSlightlySmaller);
  }
  return fail(ErrorCode::kLimitExceeded, "the mesh's smallest poster takes more than " +
                                             std::to_string(kMaxPosterBytes) +
                                             " bytes; the viewer shows the mesh without one");
}

}  // namespace qtet
