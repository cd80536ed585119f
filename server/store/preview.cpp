#include "server/store/preview.h"

#include <png.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "codec/files/field_colours.h"
#include "codec/picture/vector.h"

namespace qtet {
namespace {

/// Samples a pixel along each axis.
constexpr int kSamples = 2;
constexpr int kColumns = kPreviewWidth * kSamples;
constexpr int kRows = kPreviewHeight * kSamples;
/// The fraction of the picture's width and height that the mesh may take.
constexpr double kFill = 0.92;
constexpr Vector kEye = {1, -1.3, 0.8};
/// The light that a face turned away from the lamp still has.
constexpr double kAmbient = 0.35;

Vector unit(const Vector& a) {
  const double length = std::sqrt(dot(a, a));
  return length > 0 ? Vector{a[0] / length, a[1] / length, a[2] / length} : a;
}

/// Turns lattice points into columns, rows (downwards) and depth (towards the eye), all in samples.
class Camera {
 public:
  explicit Camera(const LatticeMesh& mesh) {
    depth_ = unit(kEye);
    right_ = unit(cross({0, 0, 1}, depth_));
    up_ = cross(depth_, right_);
    Vector least{}, most{};
    least.fill(std::numeric_limits<double>::max());
    most.fill(std::numeric_limits<double>::lowest());
    for (const Triangle& triangle : mesh.boundary)
      for (const VertexId v : triangle) {
        const Vector p = turned(mesh.points[v]);
        for (std::size_t a = 0; a < 3; ++a)
          least[a] = std::min(least[a], p[a]), most[a] = std::max(most[a], p[a]);
      }
    const double width = std::max(most[0] - least[0], 1.0),
                 height = std::max(most[1] - least[1], 1.0);
    scale_ = kFill * std::min(kColumns / width, kRows / height);
    middle_ = {(least[0] + most[0]) / 2, (least[1] + most[1]) / 2, 0};
  }

  [[nodiscard]] Vector project(const LatticePoint& point) const {
    const Vector p = turned(point);
    return {kColumns / 2.0 + scale_ * (p[0] - middle_[0]),
            kRows / 2.0 - scale_ * (p[1] - middle_[1]), scale_ * p[2]};
  }
  /// How bright a face is, 0 to 1; the lattice has the same step on every axis, so its normals are
  /// the mesh's.
  [[nodiscard]] double light(const Vector& normal) const {
    const Vector lamp = unit({depth_[0] + 0.4 * up_[0] - 0.3 * right_[0],
                              depth_[1] + 0.4 * up_[1] - 0.3 * right_[1],
                              depth_[2] + 0.4 * up_[2] - 0.3 * right_[2]});
    return kAmbient + (1 - kAmbient) * std::max(0.0, dot(normal, lamp));
  }

 private:
  [[nodiscard]] Vector turned(const LatticePoint& p) const {
    const Vector v = {static_cast<double>(p[0]), static_cast<double>(p[1]),
                      static_cast<double>(p[2])};
    return {dot(v, right_), dot(v, up_), dot(v, depth_)};
  }

  Vector right_{}, up_{}, depth_{}, middle_{};
  double scale_ = 1;
};

struct Canvas {
  std::vector<float> depth =
      std::vector<float>(std::size_t{kColumns} * kRows, std::numeric_limits<float>::lowest());
  std::vector<std::array<float, 3>> colour =
      std::vector<std::array<float, 3>>(std::size_t{kColumns} * kRows);
};

/// Twice the signed area of a, b and (x, y).
double edge(const Vector& a, const Vector& b, double x, double y) {
  return (b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0]);
}

struct Corner {
  Vector place;
  double value;
};

void drawTriangle(Canvas& canvas, const std::array<Corner, 3>& corners, double light) {
  const auto& [a, b, c] = corners;
  const double area = edge(a.place, b.place, c.place[0], c.place[1]);
  // rows go down, so a face that looks at the eye runs clockwise; the others are behind it
  if (area >= 0) return;
  const auto [left, right] = std::minmax({a.place[0], b.place[0], c.place[0]});
  const auto [top, bottom] = std::minmax({a.place[1], b.place[1], c.place[1]});
  for (int row = std::max(0, static_cast<int>(top)); row < std::min<double>(kRows, bottom + 1);
       ++row)
    for (int column = std::max(0, static_cast<int>(left));
         column < std::min<double>(kColumns, right + 1); ++column) {
      const double x = column + 0.5, y = row + 0.5;
      const double u = edge(b.place, c.place, x, y) / area, v = edge(c.place, a.place, x, y) / area,
                   w = 1 - u - v;
      if (u < 0 || v < 0 || w < 0) continue;
      const auto depth = static_cast<float>(u * a.place[2] + v * b.place[2] + w * c.place[2]);
      const std::size_t at =
          static_cast<std::size_t>(row) * kColumns + static_cast<std::size_t>(column);
      if (depth <= canvas.depth[at]) continue;
      canvas.depth[at] = depth;
      const Vector colour = viridis(u * a.value + v * b.value + w * c.value);
      for (std::size_t i = 0; i < 3; ++i)
        canvas.colour[at][i] = static_cast<float>(light * colour[i]);
    }
}

/// The mean of a pixel's samples; what is not covered is transparent.
std::array<std::uint8_t, 4> pixelOf(const Canvas& canvas, int column, int row) {
  std::array<double, 3> sum{};
  int covered = 0;
  for (int i = 0; i < kSamples * kSamples; ++i) {
    const std::size_t at = static_cast<std::size_t>(row * kSamples + i / kSamples) * kColumns +
                           static_cast<std::size_t>(column * kSamples + i % kSamples);
    if (canvas.depth[at] == std::numeric_limits<float>::lowest()) continue;
    ++covered;
    for (std::size_t c = 0; c < 3; ++c) sum[c] += static_cast<double>(canvas.colour[at][c]);
  }
  std::array<std::uint8_t, 4> out{};
  for (std::size_t c = 0; c < 3 && covered > 0; ++c)
    out[c] = static_cast<std::uint8_t>(std::lround(255 * std::min(1.0, sum[c] / covered)));
  out[3] = static_cast<std::uint8_t>(covered * 255 / (kSamples * kSamples));
  return out;
}

Result<Bytes> encodePng(const Bytes& pixels) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = kPreviewWidth;
  image.height = kPreviewHeight;
  image.format = PNG_FORMAT_RGBA;
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(image);
  Bytes out(size);
  if (png_image_write_to_memory(&image, out.data(), &size, 0, pixels.data(), 0, nullptr) == 0)
    return fail(ErrorCode::kIo, std::string("libpng cannot write the picture: ") + image.message);
  out.resize(size);
  return out;
}

}  // namespace

Result<Bytes> previewPng(const LatticeMesh& mesh) {
  if (mesh.boundary.empty())
    return fail(ErrorCode::kBadInput, "the mesh has no boundary triangle to draw");
  const Camera camera(mesh);
  const RangeFractions values(mesh, 0);
  Canvas canvas;
  for (const Triangle& triangle : mesh.boundary) {
    std::array<Corner, 3> corners{};
    std::array<Vector, 3> places{};
    for (std::size_t k = 0; k < 3; ++k) {
      const LatticePoint& p = mesh.points[triangle[k]];
      places[k] = {static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2])};
      corners[k] = {camera.project(p), values[triangle[k]]};
    }
    drawTriangle(
        canvas, corners,
        camera.light(unit(cross(minus(places[1], places[0]), minus(places[2], places[0])))));
  }
  Bytes pixels;
  pixels.reserve(std::size_t{4} * kPreviewWidth * kPreviewHeight);
  for (int row = 0; row < kPreviewHeight; ++row)
    for (int column = 0; column < kPreviewWidth; ++column)
      for (const std::uint8_t byte : pixelOf(canvas, column, row)) pixels.push_back(byte);
  return encodePng(pixels);
}

}  // namespace qtet
