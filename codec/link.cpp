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
  if (locals_.size() < vertices) locals_.resize(vertices + vertices / 2);
  if (++generation_ == 0) std::ranges::fill(locals_, Local{}), generation_ = 1;
  if (++turn_ >> (32 - kPlaceBits) != 0 || small_.empty()) small_.assign(kSmall * kSmall, 0), turn_ = 1;
  triangles_.clear();
  vertices_.clear();
  anyTriangle_.clear();
  ghostLocal_ = kNoNeighbour;
  start_ = 0;
  joined_ = 0;
  isSmall_ = true, isBad_ = false;
}

inline std::uint32_t Link::fresh(VertexId vertex) {
  vertices_.push_back(vertex);
  anyTriangle_.push_back(static_cast<std::uint32_t>(triangles_.size()));
  return static_cast<std::uint32_t>(vertices_.size() - 1);
}

inline std::uint32_t Link::intern(VertexId vertex) {
  if (vertex == kGhost) {
    if (ghostLocal_ == kNoNeighbour) ghostLocal_ = fresh(vertex);
    return ghostLocal_;
  }
  Local& local = locals_[vertex];
  if (local.generation != generation_) local = {generation_, fresh(vertex)};
  return local.id;
}

// Notes the directed edge a -> b, and makes neighbours if b -> a is known. Below kSmall vertices places fit, or some edge was met twice before.
inline void Link::meet(std::uint32_t a, std::uint32_t b, std::uint32_t place) {
  constexpr std::uint32_t kPlaces = (1u << kPlaceBits) - 1;
  std::uint32_t& here = small_[a * kSmall + b];
  isBad_ |= here >> kPlaceBits == turn_;
  here = turn_ << kPlaceBits | (place & kPlaces);
  const std::uint32_t there = small_[b * kSmall + a];
  if (there >> kPlaceBits != turn_ || isBad_) return;
  const std::uint32_t other = there & kPlaces;
  triangles_[place / 4].neighbour[place % 4] = other / 4;
  triangles_[other / 4].neighbour[other % 4] = place / 4;
  ++joined_;
}

void Link::add(VertexId a, VertexId b, VertexId c) {
  const auto f = static_cast<std::uint32_t>(triangles_.size());
  const std::array<std::uint32_t, 3> v{intern(a), intern(b), intern(c)};
  LinkTriangle& t = triangles_.emplace_back();
  t.vertex = v;
  t.neighbour.fill(kNoNeighbour);
  t.ghost = a == kGhost || b == kGhost || c == kGhost;
  isBad_ |= v[0] == v[1] || v[1] == v[2] || v[2] == v[0];
  isSmall_ &= vertices_.size() <= kSmall;
  if (isBad_ || !isSmall_) return;
  meet(v[1], v[2], 4 * f);
  meet(v[2], v[0], 4 * f + 1);
  meet(v[0], v[1], 4 * f + 2);
}

bool Link::close() {
  if (triangles_.size() < 4 || isBad_) return false;
  return isSmall_ ? 2 * std::size_t{joined_} == 3 * triangles_.size() : closeLarge();
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
  return vertex < locals_.size() && locals_[vertex].generation == generation_ ? locals_[vertex].id : kNoNeighbour;
}

void Link::place(std::span<const LatticePoint> points, const LatticePoint& centre) {
  offsets_.resize(vertices_.size());
  for (std::size_t i = 0; i < vertices_.size(); ++i) {
    const VertexId v = vertices_[i];
    offsets_[i] = v == kGhost ? LatticePoint{} : LatticePoint{points[v][0] - centre[0], points[v][1] - centre[1], points[v][2] - centre[2]};
  }
  middles_.resize(triangles_.size());
  double furthest = -1;
  for (std::uint32_t f = 0; f < triangles_.size(); ++f) {
    const LinkTriangle& t = triangles_[f];
    double squared = 0;
    for (std::size_t a = 0; a < 3; ++a) {
      const double sum = static_cast<double>(offsets_[t.vertex[0]][a] + offsets_[t.vertex[1]][a] + offsets_[t.vertex[2]][a]) * (t.ghost ? 3 : 2);
      middles_[f][a] = sum;
      squared += sum * sum;
    }
    if (squared > furthest) furthest = squared, start_ = f;
  }
}

void Link::traverse() {
  order_.resize(triangles_.size());
  seen_.assign(triangles_.size(), 0);
  std::size_t end = 0;
  order_[end++] = start_;
  seen_[start_] = 1;
  for (std::size_t i = 0; i < end; ++i)
    for (const std::uint32_t next : triangles_[order_[i]].neighbour)
      if (!seen_[next]) seen_[next] = 1, order_[end++] = next;
  order_.resize(end);
}

bool Link::isSphere() {
  const std::size_t faces = triangles_.size();
  if (faces % 2 != 0 || vertices_.size() + faces != faces / 2 * 3 + 2) return false;
  traverse();
  return order_.size() == faces;
}

}  // namespace qtet
