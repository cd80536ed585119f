#include "codec/link.h"

#include <algorithm>
#include <bit>

namespace qtet {
namespace {

constexpr std::uint64_t kFree = ~std::uint64_t{0};

std::uint64_t edgeKey(std::uint32_t a, std::uint32_t b) { return std::uint64_t{a} << 32 | b; }

std::size_t slotOf(std::uint64_t key, std::size_t mask) { return static_cast<std::size_t>((key * 0x9E3779B97F4A7C15ull) >> 40) & mask; }

}  // namespace

void Link::clear(std::size_t vertices) {
  if (stamp_.size() < vertices) stamp_.resize(vertices + vertices / 2, 0), local_.resize(stamp_.size(), 0);
  if (++generation_ == 0) std::ranges::fill(stamp_, 0u), generation_ = 1;
  triangles_.clear();
  vertices_.clear();
  anyTriangle_.clear();
  ghostLocal_ = kNoNeighbour;
  start_ = 0;
}

std::uint32_t Link::intern(VertexId vertex) {
  const auto fresh = [&] {
    vertices_.push_back(vertex);
    anyTriangle_.push_back(static_cast<std::uint32_t>(triangles_.size()));
    return static_cast<std::uint32_t>(vertices_.size() - 1);
  };
  if (vertex == kGhost) {
    if (ghostLocal_ == kNoNeighbour) ghostLocal_ = fresh();
    return ghostLocal_;
  }
  if (stamp_[vertex] != generation_) stamp_[vertex] = generation_, local_[vertex] = fresh();
  return local_[vertex];
}

void Link::add(VertexId a, VertexId b, VertexId c) {
  LinkTriangle t;
  t.vertex[0] = intern(a);
  t.vertex[1] = intern(b);
  t.vertex[2] = intern(c);
  t.neighbour.fill(kNoNeighbour);
  t.ghost = a == kGhost || b == kGhost || c == kGhost;
  triangles_.push_back(t);
}

bool Link::close() {
  if (triangles_.size() < 4) return false;
  return vertices_.size() <= kSmall ? closeSmall() : closeLarge();
}

// An entry of the table counts only if its triangle holds the edge, so the table is never cleared.
bool Link::closeSmall() {
  if (small_.empty()) small_.resize(kSmall * kSmall);
  if (triangles_.size() > 0xFFFF) return false;  // more triangles than so few vertices can have
  for (std::uint32_t f = 0; f < triangles_.size(); ++f)
    for (std::size_t e = 0; e < 3; ++e) {
      const std::uint32_t a = triangles_[f].vertex[(e + 1) % 3], b = triangles_[f].vertex[(e + 2) % 3];
      std::uint16_t& entry = small_[a * kSmall + b];
      if (entry < f && triangles_[entry].holds(a, b)) return false;
      entry = static_cast<std::uint16_t>(f);
    }
  for (LinkTriangle& t : triangles_)
    for (std::size_t e = 0; e < 3; ++e) {
      const std::uint32_t a = t.vertex[(e + 2) % 3], b = t.vertex[(e + 1) % 3];
      const std::uint16_t f = small_[a * kSmall + b];
      if (f >= triangles_.size() || !triangles_[f].holds(a, b)) return false;
      t.neighbour[e] = f;
    }
  return true;
}

bool Link::closeLarge() {
  const std::size_t wanted = std::bit_ceil(triangles_.size() * 6 + 8);
  if (edgeKeys_.size() < wanted) edgeKeys_.resize(wanted), edgeTriangles_.resize(wanted);
  const std::size_t mask = wanted - 1;
  std::fill_n(edgeKeys_.begin(), wanted, kFree);
  for (std::uint32_t f = 0; f < triangles_.size(); ++f)
    for (std::size_t e = 0; e < 3; ++e) {
      const std::uint64_t key = edgeKey(triangles_[f].vertex[(e + 1) % 3], triangles_[f].vertex[(e + 2) % 3]);
      std::size_t slot = slotOf(key, mask);
      for (; edgeKeys_[slot] != kFree; slot = (slot + 1) & mask)
        if (edgeKeys_[slot] == key) return false;
      edgeKeys_[slot] = key;
      edgeTriangles_[slot] = f;
    }
  for (LinkTriangle& t : triangles_)
    for (std::size_t e = 0; e < 3; ++e) {
      const std::uint64_t key = edgeKey(t.vertex[(e + 2) % 3], t.vertex[(e + 1) % 3]);
      std::size_t slot = slotOf(key, mask);
      while (edgeKeys_[slot] != kFree && edgeKeys_[slot] != key) slot = (slot + 1) & mask;
      if (edgeKeys_[slot] == kFree) return false;
      t.neighbour[e] = edgeTriangles_[slot];
    }
  return true;
}

std::uint32_t Link::triangleAtEdge(std::uint32_t a, std::uint32_t b) const {
  for (std::uint32_t f = 0; f < triangles_.size(); ++f)
    if (triangles_[f].holds(a, b)) return f;
  return kNoNeighbour;
}

std::uint32_t Link::localOf(VertexId vertex) const {
  if (vertex == kGhost) return ghostLocal_;
  return vertex < stamp_.size() && stamp_[vertex] == generation_ ? local_[vertex] : kNoNeighbour;
}

void Link::place(std::span<const LatticePoint> points, const LatticePoint& centre) {
  offsets_.clear();
  for (const VertexId v : vertices_)
    offsets_.push_back(v == kGhost ? LatticePoint{} : LatticePoint{points[v][0] - centre[0], points[v][1] - centre[1], points[v][2] - centre[2]});
  double furthest = -1;
  for (std::uint32_t f = 0; f < triangles_.size(); ++f) {
    double squared = 0;
    for (const std::int64_t x : sixTimesMiddle(triangles_[f])) squared += static_cast<double>(x) * static_cast<double>(x);
    if (squared > furthest) furthest = squared, start_ = f;
  }
}

void Link::traverse() {
  order_.clear();
  seen_.assign(triangles_.size(), 0);
  order_.push_back(start_);
  seen_[start_] = 1;
  for (std::size_t i = 0; i < order_.size(); ++i)
    for (const std::uint32_t next : triangles_[order_[i]].neighbour)
      if (!seen_[next]) seen_[next] = 1, order_.push_back(next);
}

bool Link::isSphere() {
  const std::size_t faces = triangles_.size();
  if (faces % 2 != 0 || vertices_.size() + faces != faces / 2 * 3 + 2) return false;
  traverse();
  return order_.size() == faces;
}

}  // namespace qtet
