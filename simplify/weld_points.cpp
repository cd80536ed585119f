#include "simplify/weld_points.h"

#include <array>
#include <bit>
#include <cmath>
#include <numeric>
#include <unordered_map>

namespace qtet {
namespace {

using Box = std::array<double, 3>;

struct BoxHash {
  std::size_t operator()(const Box& box) const {
    std::uint64_t hash = 0;
    for (const double x : box) hash = (hash ^ std::bit_cast<std::uint64_t>(x)) * 0x9E3779B97F4A7C15u, hash ^= hash >> 29;
    return static_cast<std::size_t>(hash);
  }
};

/// The points that stay, by boxes of twice the distance (by their place itself where that is 0), so that a ball meets at most eight boxes.
class KeptPoints {
 public:
  KeptPoints(const std::vector<Position>& points, double distance) : points_(points), distance_(distance), next_(points.size(), kGhost) {
    first_.reserve(points.size());
  }

  /// The smallest id of a kept point within the distance; kGhost: none.
  [[nodiscard]] VertexId near(const Position& p) const {
    if (distance_ == 0) return nearIn(boxOf(p), p);
    VertexId found = kGhost;
    const Box low = boxOf({p[0] - distance_, p[1] - distance_, p[2] - distance_}), high = boxOf({p[0] + distance_, p[1] + distance_, p[2] + distance_});
    for (double x = low[0]; x <= high[0]; x += 1) {
      for (double y = low[1]; y <= high[1]; y += 1) {
        for (double z = low[2]; z <= high[2]; z += 1) found = std::min(found, nearIn({x, y, z}, p));
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
    if (distance_ == 0) return {p[0] + 0.0, p[1] + 0.0, p[2] + 0.0};  // -0 and 0 are one place
    return {std::floor(p[0] / (2 * distance_)) + 0.0, std::floor(p[1] / (2 * distance_)) + 0.0, std::floor(p[2] / (2 * distance_)) + 0.0};
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

void rename(CellMesh& mesh, const std::vector<VertexId>& names) {
  for (std::size_t i = 0; i < mesh.cells(); ++i) {
    const std::span<VertexId> ids = std::span(mesh.vertices).subspan(mesh.begins[i], mesh.begins[i + 1] - mesh.begins[i]);
    if (mesh.types[i] != kPolyhedronCell) {
      for (VertexId& v : ids) v = names[v];
      continue;
    }
    for (std::size_t at = 1; at < ids.size(); at += ids[at] + 1) {
      for (VertexId& v : ids.subspan(at + 1, ids[at])) v = names[v];
    }
  }
}

}  // namespace

std::uint64_t weldPoints(CellMesh& mesh, double distance) {
  KeptPoints kept(mesh.points, distance);
  std::vector<VertexId> names(mesh.points.size());
  std::uint64_t joined = 0;
  for (VertexId v = 0; v < names.size(); ++v) {
    const VertexId earlier = kept.near(mesh.points[v]);
    names[v] = earlier == kGhost ? v : earlier;
    earlier == kGhost ? kept.keep(v) : static_cast<void>(++joined);
  }
  if (joined > 0) rename(mesh, names);
  return joined;
}

}  // namespace qtet
