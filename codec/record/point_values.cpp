#include "codec/record/point_values.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace qtet {
namespace {

using Vector = std::array<double, 3>;

// Only + - * / and comparisons, so that every machine finds the same weights.
template <class B>
Vector cross(const Vector& a, const B& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
template <class B>
double dot(const Vector& a, const B& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
Vector between(const LatticePoint& from, const LatticePoint& to) {
  return {static_cast<double>(to[0] - from[0]), static_cast<double>(to[1] - from[1]),
          static_cast<double>(to[2] - from[2])};
}

// A star that ends after less than this share of the step says nothing of it.
constexpr double kMinReach = 0.25;

// A fused vertex lies near its edge. A step further along than this is cut to it, which keeps every
// prediction within 64 bits.
constexpr double kMaxSteps = 4;

/// Where a line through the fused vertex leaves the star.
struct Exit {
  double reach = 0;                       // in steps
  std::array<std::uint32_t, 3> corner{};  // local ids
  Vector share{};                         // barycentric
  bool isBeyond = false;                  // past an edge of the boundary

  /// Takes one that is further away.
  void extend(const Exit& other) {
    if (std::fabs(other.reach) > std::fabs(reach)) *this = other;
  }
};
/// Against the step, along it.
using Exits = std::array<Exit, 2>;

Vector vectorOf(const Link::Offset& offset) { return {offset[0], offset[1], offset[2]}; }

bool isShort(const Exit& exit) { return std::fabs(exit.reach) < kMinReach; }

// A boundary's edge (x, y) goes on outwards: the exit lies at y + share (x - y) + out * something,
// away from the star's middle.
void addBeyond(const Link& link, const Vector& step, Exits& exits) {
  const std::span<const Link::Offset> corners = link.offsets();
  Vector out{};
  for (const Link::Offset& corner : corners)
    for (std::size_t a = 0; a < 3; ++a) out[a] -= corner[a];
  const std::array<bool, 2> isWanted{isShort(exits[0]), isShort(exits[1])};
  for (const LinkTriangle& t : link.triangles()) {
    if (!t.ghost) continue;
    std::array<std::uint32_t, 2> edge{};
    std::size_t n = 0;
    for (const std::uint32_t v : t.vertex)
      if (link.vertices()[v] != kGhost && n < edge.size()) edge[n++] = v;
    const Vector x = vectorOf(corners[edge[0]]), y = vectorOf(corners[edge[1]]);
    const Vector along{x[0] - y[0], x[1] - y[1], x[2] - y[2]};
    const Vector acrossOut = cross(step, out);
    const double volume = dot(along, acrossOut);
    if (volume == 0) continue;
    // Cramer's rule for share * along - reach * step + distance * out = -y.
    const Vector across = cross(along, y);
    const double share = -dot(y, acrossOut) / volume, reach = dot(across, out) / volume,
                 distance = dot(across, step) / volume;
    if (!(share >= 0 && share <= 1 && distance >= 0) || reach == 0) continue;
    const std::size_t side = reach > 0;
    if (isWanted[side])
      exits[side].extend({reach, {edge[0], edge[1], edge[1]}, {share, 1 - share, 0}, true});
  }
}

std::uint16_t reachOf(const Exit& exit) {
  if (exit.reach == 0) return 0;
  const double reach = std::floor(std::fabs(exit.reach) * (1 << Slope::kReachBits) + 0.5);
  return static_cast<std::uint16_t>(
      static_cast<std::uint16_t>(std::fmin(std::fmax(reach, 1), Slope::kMaxReach)) |
      (exit.isBeyond ? Slope::kBeyond : 0));
}

}  // namespace

void PointAncestry::reserve(std::uint64_t records, std::uint64_t vertices) {
  births_.reserve(static_cast<std::size_t>(records));
  slopes_.reserve(static_cast<std::size_t>(slopesOf(records, vertices)));
}

void PointAncestry::add(VertexId v, const GrowingMesh& mesh, const Link& link, const Split& split) {
  assert(link.triangles().size() == mesh.star(v).size());
  Birth birth{v,
              mesh.next().vertices,
              static_cast<std::uint32_t>(slopes_.size()),
              0,
              static_cast<std::uint8_t>(split.k),
              static_cast<std::uint8_t>(static_cast<int>(split.placement) + 4 * split.near)};
  if (mesh.level() != level_ || births_.empty()) {
    level_ = mesh.level();
    levelStarts_.push_back(static_cast<std::uint32_t>(births_.size()));
  }
  if (withSlopes_) {
    const LatticePoint& fused = mesh.points[v];
    if (split.k == 2) {
      const Vector step = between(split.points[0], split.points[1]);
      const double length = dot(step, step);
      const double along = length > 0 ? dot(between(fused, split.points[0]), step) / length : 0;
      birth.step = static_cast<std::int16_t>(std::floor(
          std::fmin(std::fmax(along, -kMaxSteps), kMaxSteps) * (1 << Birth::kStepBits) + 0.5));
      addSlope(link, step);
    } else {
      for (std::size_t i = 0; i < static_cast<std::size_t>(split.k); ++i)
        addSlope(link, between(fused, split.points[i]));
    }
  }
  births_.push_back(birth);
}

void PointAncestry::addSlope(const Link& link, const std::array<double, 3>& step) {
  const std::span<const Link::Offset> corners = link.offsets();
  if (turned_.size() < corners.size()) turned_.resize(corners.size());
  for (std::size_t i = 0; i < corners.size(); ++i) turned_[i] = cross(step, corners[i]);
  Exits exits;
  for (const LinkTriangle& t : link.triangles()) {
    if (t.ghost) continue;
    const auto [i, j, k] = t.vertex;
    // Volumes of (step, corner, corner): all of one sign where the line passes the triangle.
    const double a = dot(turned_[j], corners[k]), b = dot(turned_[k], corners[i]),
                 c = dot(turned_[i], corners[j]);
    const double sum = a + b + c;
    const bool negative = (static_cast<unsigned>(a < 0) | static_cast<unsigned>(b < 0) |
                           static_cast<unsigned>(c < 0)) != 0;
    const bool positive = (static_cast<unsigned>(a > 0) | static_cast<unsigned>(b > 0) |
                           static_cast<unsigned>(c > 0)) != 0;
    if (negative == positive || sum == 0) continue;
    const double reach = dot(vectorOf(corners[i]), cross(vectorOf(corners[j]), corners[k])) / sum;
    exits[reach > 0].extend({reach, t.vertex, {a / sum, b / sum, c / sum}});
  }
  if (isShort(exits[0]) || isShort(exits[1])) addBeyond(link, step, exits);
  Slope slope;
  const double reach = exits[1].reach - exits[0].reach;
  if (reach >= kMinReach)
    for (std::size_t side = 0; side < 2; ++side) {
      slope.reach[side] = reachOf(exits[side]);
      for (std::size_t i = 0; i < 3 && exits[side].reach != 0; ++i) {
        const double weight = (side == 0 ? -1 : 1) * exits[side].share[i] / reach;
        slope.vertex[3 * side + i] = link.vertices()[exits[side].corner[i]];
        slope.weight[3 * side + i] =
            static_cast<std::int16_t>(std::floor(weight * (1 << Slope::kWeightBits) + 0.5));
      }
    }
  slopes_.push_back(slope);
}

}  // namespace qtet
