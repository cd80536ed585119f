#include "simplify/read/parts/weld_points.h"

#include <array>
#include <bit>
#include <cassert>
#include <cmath>
#include <numeric>
#include <unordered_map>

namespace qtet {
namespace {

using Box = std::array<double, 3>;

constexpr double kFirstInexactInteger = 9007199254740992.0;  // 2^53

struct BoxHash {
  std::size_t operator()(const Box& box) const {
    std::uint64_t hash = 0;
    for (const double x : box)
      hash = (hash ^ std::bit_cast<std::uint64_t>(x)) * 0x9E3779B97F4A7C15u, hash ^= hash >> 29;
    return static_cast<std::size_t>(hash);
  }
};

/// The points that stay, by boxes of twice the distance (by their place itself where that is 0), so
/// that a ball meets eight boxes.
class KeptPoints {
  struct Boxes {
    std::array<double, 3> box{};
    std::size_t count = 0;
  };

 public:
  KeptPoints(const std::vector<Position>& points, double distance)
      : points_(points), distance_(distance), next_(points.size(), kGhost) {
    first_.reserve(points.size());
  }

  /// The smallest id of a kept point within the distance; kGhost: none.
  [[nodiscard]] VertexId near(const Position& p) const {
    if (distance_ == 0) return nearIn(boxOf(p), p);
    VertexId found = kGhost;
    const std::array<Boxes, 3> boxes{boxesRound(p[0]), boxesRound(p[1]), boxesRound(p[2])};
    for (std::size_t i = 0; i < boxes[0].count; ++i) {
      for (std::size_t j = 0; j < boxes[1].count; ++j) {
        for (std::size_t k = 0; k < boxes[2].count; ++k)
          found = std::min(found, nearIn({boxes[0].box[i], boxes[1].box[j], boxes[2].box[k]}, p));
      }
    }
    return found;
  }

  void keep(VertexId v) {
    VertexId& first = first_.try_emplace(boxOf(points_[v]), kGhost).first->second;
    next_[v] = first;
    first = v;
  }

 private:
  [[nodiscard]] Box boxOf(const Position& p) const {
    return {boxOf(p[0]), boxOf(p[1]), boxOf(p[2])};
  }
  /// Where boxes are narrower than doubles are apart, two places within the distance are one, and
  /// that is the box. (+ 0.0: -0 and 0 are one place.)
  [[nodiscard]] double boxOf(double x) const {
    const double box = distance_ == 0 ? x : std::floor(x / (2 * distance_));
    return (std::abs(box) < kFirstInexactInteger ? box : x) + 0.0;
  }
  /// Along one axis those that a ball at x meets: two, or three where rounding puts an end into the
  /// next one.
  [[nodiscard]] Boxes boxesRound(double x) const {
    Boxes out;
    for (const double place : {x - distance_, x, x + distance_}) {
      const double box = boxOf(place);
      if (out.count == 0 || out.box[out.count - 1] != box) out.box[out.count++] = box;
    }
    return out;
  }
  [[nodiscard]] VertexId nearIn(const Box& box, const Position& p) const {
    const auto at = first_.find(box);
    VertexId found = kGhost;
    for (VertexId v = at == first_.end() ? kGhost : at->second; v != kGhost; v = next_[v]) {
      const Position& q = points_[v];
      const double dx = p[0] - q[0], dy = p[1] - q[1], dz = p[2] - q[2];
      if (dx * dx + dy * dy + dz * dz <= distance_ * distance_) found = std::min(found, v);
    }
    return found;
  }

  const std::vector<Position>& points_;
  double distance_;
  std::unordered_map<Box, VertexId, BoxHash> first_;
  std::vector<VertexId> next_;  ///< the kept point before it in the same box
};

}  // namespace

std::uint64_t weldPoints(CellMesh& mesh, double distance) {
  assert(distance >= 0);
  KeptPoints kept(mesh.points, distance);
  std::vector<VertexId> names(mesh.points.size());
  std::uint64_t joined = 0;
  for (VertexId v = 0; v < names.size(); ++v) {
    const VertexId earlier = kept.near(mesh.points[v]);
    names[v] = earlier == kGhost ? v : earlier;
    earlier == kGhost ? kept.keep(v) : static_cast<void>(++joined);
  }
  if (joined > 0) mesh.renamePoints(names);
  return joined;
}

}  // namespace qtet
