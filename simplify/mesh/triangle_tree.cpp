#include "simplify/mesh/triangle_tree.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace qtet {
namespace {

/// Triangles of a leaf: boxes are cheaper to test than triangles, but each one is a cache line.
constexpr std::uint32_t kLeafTriangles = 2;
/// The tree is tried at the middles of kTrials triangles. If more than kCrowd boxes hold one on
/// average, there are slabs. On the boundaries of comb, bluntfin-welded, fea-kiefer and linkrods-1m
/// 23 to 28 boxes do, on that of a fan of 20,000 tetrahedra 2,500.
constexpr std::size_t kTrials = 64, kCrowd = 150;
/// Lattice steps that a slab's distance may be too large by, from rounding: coordinates below 2^30
/// times unit vectors in doubles.
constexpr double kSlabRounding = 0x1p-18;

}  // namespace

TriangleTree::TriangleTree(std::span<const LatticePoint> points, std::span<const Cell> cells,
                           std::vector<std::uint32_t> ids)
    : points_(points), cells_(cells), ids_(std::move(ids)) {
  assert(ids_.size() <= cells_.size());
  nodes_.reserve(ids_.size());
  build(0, static_cast<std::uint32_t>(ids_.size()));
  places_.reserve(ids_.size());
  for (const std::uint32_t id : ids_) places_.push_back(placeOf(id));
  assert(nodes_.size() < 2 * std::max<std::size_t>(1, ids_.size()));
  if (isCrowded()) fitSlabs({});
}

bool TriangleTree::isCrowded() const {
  if (ids_.size() < kCrowd) return false;
  std::size_t boxes = 0;
  std::vector<std::uint32_t> waiting;
  for (std::size_t trial = 0; trial < kTrials && boxes <= kTrials * kCrowd; ++trial) {
    const Cell& cell = cells_[ids_[trial * ids_.size() / kTrials]];
    const Vector3 middle =
        1 / 3.0 *
        (toVector(points_[cell[0]]) + toVector(points_[cell[1]]) + toVector(points_[cell[2]]));
    waiting.push_back(0);
    while (!waiting.empty() && boxes <= kTrials * kCrowd) {
      const std::uint32_t index = waiting.back();
      waiting.pop_back();
      if (squaredDistance(middle, nodes_[index]) > 0) continue;
      ++boxes;
      if (nodes_[index].right != 0) waiting.insert(waiting.end(), {index + 1, nodes_[index].right});
    }
  }
  return boxes > kTrials * kCrowd;
}

void TriangleTree::fitSlabs(std::span<const std::uint8_t> live) {
  assert(live.empty() || live.size() == cells_.size());
  slabs_.resize(nodes_.size());
  for (std::size_t i = 0; i < nodes_.size(); ++i) slabs_[i] = slabsOf(nodes_[i], live);
}

// The frame of the triangle in the middle: neighbours in the tree are neighbours on the surface.
// Any directions would be right, these are narrow.
TriangleTree::Slabs TriangleTree::slabsOf(const Node& node,
                                          std::span<const std::uint8_t> live) const {
  constexpr double kNone = std::numeric_limits<double>::infinity();
  Slabs out{{}, {kNone, kNone}, {-kNone, -kNone}};
  const std::span<const std::uint32_t> ids = std::span(ids_).subspan(node.first, node.count);
  if (ids.empty()) return out;
  const auto corner = [&](std::uint32_t id, std::size_t c) {
    return toVector(points_[cells_[id][c]]);
  };
  const std::uint32_t middle = ids[ids.size() / 2];
  Vector3 longest{};
  for (std::size_t c = 0; c < 3; ++c) {
    const Vector3 edge = corner(middle, (c + 1) % 3) - corner(middle, c);
    if (dot(edge, edge) > dot(longest, longest)) longest = edge;
  }
  const Vector3 normal =
      cross(corner(middle, 1) - corner(middle, 0), corner(middle, 2) - corner(middle, 0));
  out.axis = {cross(normal, longest), normal};
  for (Vector3& axis : out.axis) {
    const double length = std::sqrt(dot(axis, axis));
    // a degenerate triangle has slabs that leave nothing out
    if (length > 0) axis = 1 / length * axis;
  }
  for (const std::uint32_t id : ids) {
    if (!live.empty() && live[id] == 0) continue;
    for (std::size_t c = 0; c < 3; ++c)
      for (std::size_t k = 0; k < 2; ++k) {
        const double along = dot(out.axis[k], corner(id, c));
        out.low[k] = std::min(out.low[k], along);
        out.high[k] = std::max(out.high[k], along);
      }
  }
  return out;
}

void TriangleTree::clear(Node& node) {
  node.low.fill(std::numeric_limits<std::int32_t>::max());
  node.high.fill(std::numeric_limits<std::int32_t>::min());
}

bool TriangleTree::enclose(Node& node, const Place& place) {
  bool grows = false;
  for (const LatticePoint& p : place)
    for (std::size_t k = 0; k < 3; ++k) {
      grows |= p[k] < node.low[k] || p[k] > node.high[k];
      node.low[k] = std::min(node.low[k], p[k]);
      node.high[k] = std::max(node.high[k], p[k]);
    }
  return grows;
}

void TriangleTree::build(std::uint32_t first, std::uint32_t count) {
  assert(first + count <= ids_.size());
  const auto index = static_cast<std::uint32_t>(nodes_.size());
  nodes_.push_back({{}, {}, 0, first, count});
  clear(nodes_[index]);
  for (const std::uint32_t id : std::span(ids_).subspan(first, count))
    enclose(nodes_[index], placeOf(id));
  if (count <= kLeafTriangles) return;
  const Node& box = nodes_[index];
  std::size_t axis = 0;
  for (std::size_t k = 1; k < 3; ++k)
    if (box.high[k] - box.low[k] > box.high[axis] - box.low[axis]) axis = k;
  // three times the centroid; the id makes the order total
  const auto place = [&](std::uint32_t id) {
    std::int64_t sum = 0;
    for (std::size_t corner = 0; corner < 3; ++corner) sum += points_[cells_[id][corner]][axis];
    return std::pair{sum, id};
  };
  const std::uint32_t half = count / 2;
  const auto begin = ids_.begin() + first;
  std::nth_element(begin, begin + half, begin + count,
                   [&](std::uint32_t a, std::uint32_t b) { return place(a) < place(b); });
  build(first, half);
  nodes_[index].right = static_cast<std::uint32_t>(nodes_.size());
  build(first + half, count - half);
}

void TriangleTree::allowGrowth() {
  parents_.assign(nodes_.size(), kNoNode);
  leaves_.assign(cells_.size(), kNoNode);
  for (std::uint32_t i = 0; i < nodes_.size(); ++i)
    if (nodes_[i].right != 0) {
      parents_[i + 1] = parents_[nodes_[i].right] = i;
    } else {
      for (const std::uint32_t id : std::span(ids_).subspan(nodes_[i].first, nodes_[i].count))
        leaves_[id] = i;
    }
}

void TriangleTree::grow(std::uint32_t triangle) {
  assert(triangle < leaves_.size());
  assert(!parents_.empty() && leaves_[triangle] != kNoNode);
  const Place place = placeOf(triangle);
  const Node& leaf = nodes_[leaves_[triangle]];
  for (std::uint32_t i = leaf.first; i < leaf.first + leaf.count; ++i)
    if (ids_[i] == triangle) places_[i] = place;
  for (std::uint32_t i = leaves_[triangle]; i != kNoNode; i = parents_[i])
    if (!enclose(nodes_[i], place)) break;
}

void TriangleTree::refit(std::span<const std::uint8_t> live) {
  assert(live.size() == cells_.size());
  for (std::size_t i = nodes_.size(); i-- > 0;) {  // children stand behind their parent
    Node& node = nodes_[i];
    if (node.right == 0) {
      const auto begin = ids_.begin() + node.first;
      const auto end = std::partition(begin, begin + node.count,
                                      [&](std::uint32_t id) { return live[id] != 0; });
      node.count = static_cast<std::uint32_t>(end - begin);
      clear(node);
      for (std::uint32_t at = node.first; at < node.first + node.count; ++at)
        enclose(node, places_[at] = placeOf(ids_[at]));
      continue;
    }
    assert(node.right > i + 1 && node.right < nodes_.size());
    const Node &left = nodes_[i + 1], &right = nodes_[node.right];
    for (std::size_t k = 0; k < 3; ++k) {
      node.low[k] = std::min(left.low[k], right.low[k]);
      node.high[k] = std::max(left.high[k], right.high[k]);
    }
  }
  if (!slabs_.empty()) fitSlabs(live);
}

double TriangleTree::squaredDistance(const Vector3& p, const Slabs& slabs) {
  double sum = 0;
  for (std::size_t k = 0; k < 2; ++k) {
    const double along = dot(slabs.axis[k], p);
    const double apart =
        std::max(std::max(slabs.low[k] - along, along - slabs.high[k]) - kSlabRounding, 0.0);
    sum += apart * apart;
  }
  return sum;
}

double TriangleTree::squaredDistance(const Vector3& p, const Node& node) {
  double sum = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const double below = static_cast<double>(node.low[k]) - p[k],
                 above = p[k] - static_cast<double>(node.high[k]);
    const double apart = std::max({below, above, 0.0});
    sum += apart * apart;
  }
  return sum;
}

void TriangleTree::tryTriangle(const Vector3& p, std::uint32_t triangle,
                               NearestTriangle& best) const {
  tryPlace(p, placeOf(triangle), triangle, best);
}

void TriangleTree::tryPlace(const Vector3& p, const Place& place, std::uint32_t triangle,
                            NearestTriangle& best) {
  const NearestPoint found = nearestOnTriangle(p, toVectors(place));
  if (found.squared < best.point.squared) best = {triangle, found};
}

std::size_t TriangleTree::nearest(const Vector3& p, NearestTriangle& best, double enough) const {
  assert(!nodes_.empty());
  struct Waiting {
    double squared;
    std::uint32_t node;
  };
  std::array<Waiting, kMaxWaiting> waiting;
  std::size_t size = 0, looked = 0;
  const auto minSquared = [&](std::uint32_t node) {
    const double squared = squaredDistance(p, nodes_[node]);
    return slabs_.empty() ? squared : std::max(squared, squaredDistance(p, slabs_[node]));
  };
  waiting[size++] = {minSquared(0), 0};
  while (size > 0 && best.point.squared > enough) {
    auto [squared, index] = waiting[--size];
    while (squared < best.point.squared) {
      ++looked;
      const Node& node = nodes_[index];
      if (node.right == 0) {
        for (std::uint32_t i = node.first; i < node.first + node.count; ++i)
          tryPlace(p, places_[i], ids_[i], best);
        break;
      }
      Waiting near{minSquared(index + 1), index + 1}, far{minSquared(node.right), node.right};
      if (far.squared < near.squared) std::swap(near, far);
      assert(size < kMaxWaiting && near.squared <= far.squared);
      if (far.squared < best.point.squared) waiting[size++] = far;
      squared = near.squared;
      index = near.node;
    }
  }
  return looked;
}

}  // namespace qtet
