#include "simplify/read/parts/weld_points.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>
#include <numeric>
#include <unordered_map>

#include "proto/field_name.h"

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
  KeptPoints(const CellMesh& mesh, double distance, std::string_view motion)
      : points_(mesh.points), distance_(distance), next_(mesh.points.size(), kGhost) {
    first_.reserve(points_.size());
    if (motion.empty()) return;
    for (const MeshField& field : mesh.fields)
      if (!isCellField(field) && field.name.isInstant() && field.name.withoutTime() == motion)
        displacements_.push_back(&field);
  }

  /// The smallest id of a kept point within the distance of v; kGhost: none.
  [[nodiscard]] VertexId near(VertexId v) const {
    const Position& p = points_[v];
    if (distance_ == 0) return nearIn(boxOf(p), v);
    VertexId found = kGhost;
    const std::array<Boxes, 3> boxes{boxesRound(p[0]), boxesRound(p[1]), boxesRound(p[2])};
    for (std::size_t i = 0; i < boxes[0].count; ++i) {
      for (std::size_t j = 0; j < boxes[1].count; ++j) {
        for (std::size_t k = 0; k < boxes[2].count; ++k)
          found = std::min(found, nearIn({boxes[0].box[i], boxes[1].box[j], boxes[2].box[k]}, v));
      }
    }
    return found;
  }

  void keep(VertexId v) {
    assert(next_[v] == kGhost);
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
      assert(out.count < out.box.size());
      if (out.count == 0 || out.box[out.count - 1] != box) out.box[out.count++] = box;
    }
    return out;
  }
  [[nodiscard]] VertexId nearIn(const Box& box, VertexId v) const {
    const auto at = first_.find(box);
    VertexId found = kGhost;
    for (VertexId w = at == first_.end() ? kGhost : at->second; w != kGhost; w = next_[w])
      if (isWithin(apart(v, w)) && stayTogether(v, w)) found = std::min(found, w);
    return found;
  }
  [[nodiscard]] Position apart(VertexId v, VertexId w) const {
    const Position &p = points_[v], &q = points_[w];
    return {p[0] - q[0], p[1] - q[1], p[2] - q[2]};
  }
  [[nodiscard]] bool isWithin(const Position& d) const {
    return d[0] * d[0] + d[1] * d[1] + d[2] * d[2] <= distance_ * distance_;
  }
  /// Whether they are within the distance at every instant.
  [[nodiscard]] bool stayTogether(VertexId v, VertexId w) const {
    return std::ranges::all_of(displacements_, [&](const MeshField* field) {
      Position d = apart(v, w);
      for (std::size_t c = 0; c < 3; ++c)
        d[c] += field->values[3 * std::size_t{v} + c] - field->values[3 * std::size_t{w} + c];
      return isWithin(d);
    });
  }

  const std::vector<Position>& points_;
  double distance_;
  std::vector<const MeshField*> displacements_;  ///< one an instant
  std::unordered_map<Box, VertexId, BoxHash> first_;
  std::vector<VertexId> next_;  ///< the kept point before it in the same box
};

}  // namespace

std::uint64_t weldPoints(CellMesh& mesh, double distance, std::string_view motion) {
  assert(distance >= 0);
  KeptPoints kept(mesh, distance, motion);
  std::vector<VertexId> names(mesh.points.size());
  std::uint64_t joined = 0;
  for (VertexId v = 0; v < names.size(); ++v) {
    const VertexId earlier = kept.near(v);
    assert(earlier == kGhost || (earlier < v && names[earlier] == earlier));
    names[v] = earlier == kGhost ? v : earlier;
    earlier == kGhost ? kept.keep(v) : static_cast<void>(++joined);
  }
  if (joined > 0) mesh.renamePoints(names);
  return joined;
}

}  // namespace qtet
