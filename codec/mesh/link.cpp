#include "codec/mesh/link.h"

#include <algorithm>
#include <bit>
#include <cassert>

#include "codec/coding/log2_fixed.h"
#include "codec/coding/pair.h"

namespace qtet {
namespace {

constexpr std::uint64_t kFree = ~std::uint64_t{0};

std::uint64_t edgeKey(std::uint32_t a, std::uint32_t b) { return std::uint64_t{a} << 32 | b; }

std::size_t slotOf(std::uint64_t key, std::size_t mask) {
  return static_cast<std::size_t>((key * 0x9E3779B97F4A7C15ull) >> 40) & mask;
}

}  // namespace

void Link::clear(std::size_t vertices) {
  if (locals_.size() <= vertices) locals_.resize(vertices + vertices / 2 + 1);
  if (++generation_ == 0) std::ranges::fill(locals_, Local{}), generation_ = 1;
  triangleCount_ = vertexCount_ = 0;
  start_ = 0;
}

void Link::makeRoom(std::size_t triangles) {
  if (triangles < triangles_.size()) return;
  const std::size_t room = triangles + triangles / 2 + 1;
  triangles_.resize(room);
  vertices_.resize(3 * room);
  anyTriangle_.resize(3 * room);
  offsets_.resize(3 * room);
  labelsRound_.resize(3 * room);
  middles_.resize(room);
  order_.resize(room);
}

// Does not branch on whether a vertex is new: half of them are, in no order that a processor could
// guess. An entry written for a known vertex is overwritten by the next.
void Link::add(std::span<const Triangle> triangles) {
  makeRoom(triangleCount_ + triangles.size());
  std::uint32_t count = vertexCount_, f = triangleCount_;
  const std::uint32_t generation = generation_;
  Local* const locals = locals_.data();
  VertexId* const vertices = vertices_.data();
  std::uint32_t* const anyTriangle = anyTriangle_.data();
  LabelCounts* const labelsRound = labelsRound_.data();
  const auto intern = [&](VertexId vertex) {
    Local& local = locals[localSlot(vertex)];
    const auto fresh = static_cast<std::uint32_t>(local.generation != generation);
    const std::uint32_t id = local.id ^ ((local.id ^ count) & (0 - fresh));
    local = {generation, id};
    vertices[count] = vertex;
    anyTriangle[count] = f;
    labelsRound[count] = 0;
    count += fresh;
    return id;
  };
  for (const Triangle& given : triangles) {
    LinkTriangle& t = triangles_[f];
    t.vertex = {intern(given[0]), intern(given[1]), intern(given[2])};
    t.label = kNoLabel;
    t.ghost = static_cast<unsigned>(given[0] == kGhost) |
              static_cast<unsigned>(given[1] == kGhost) | static_cast<unsigned>(given[2] == kGhost);
    ++f;
  }
  triangleCount_ = f, vertexCount_ = count;
}

bool Link::close() {
  if (triangleCount_ < 4) return false;
  return vertexCount_ <= kSmall ? closeSmall() : closeLarge();
}

// An entry of this turn is at least `first` and less than 2^kPlaceBits above it. One of an earlier
// turn is below, so the sign of the difference decides.
bool Link::closeSmall() {
  constexpr std::int32_t kPlaces = 1 << kPlaceBits;
  static_assert(4 * kSmall * kSmall / 3 < kPlaces);
  if (triangleCount_ > kSmall * kSmall / 3) return false;  // some edge is there twice
  if (++turn_ == kTurns || small_.empty()) small_.assign(kSmall * kSmall, 0), turn_ = 1;
  const std::int32_t first = turn_ << kPlaceBits;
  std::int32_t* const small = small_.data();
  // negative: every edge that was met had not been met before, every edge that is looked for was
  // met
  std::int32_t old = -1, fresh = 0;
  std::int32_t place = first;
  const auto meet = [&](std::uint32_t a, std::uint32_t b, std::int32_t at) {
    std::int32_t& here = small[a * kSmall + b];
    old &= here - first;
    here = at;
  };
  const std::span<LinkTriangle> all(triangles_.data(), triangleCount_);
  for (const LinkTriangle& t : all) {
    const auto [a, b, c] = t.vertex;
    meet(b, c, place), meet(c, a, place + 1), meet(a, b, place + 2);
    place += 4;
  }
  const auto across = [&](std::uint32_t a, std::uint32_t b) {
    const std::int32_t there = small[b * kSmall + a] - first;
    fresh |= there;
    return static_cast<std::uint32_t>(there) / 4;
  };
  for (LinkTriangle& t : all) {
    const auto [a, b, c] = t.vertex;
    t.neighbour = {across(b, c), across(c, a), across(a, b)};
  }
  // of an edge from a vertex to itself
  for (std::uint32_t v = 0; v < vertexCount_; ++v) old &= small[v * (kSmall + 1)] - first;
  return old < 0 && fresh >= 0;
}

bool Link::closeLarge() {
  const std::span<LinkTriangle> triangles(triangles_.data(), triangleCount_);
  const std::size_t wanted = std::bit_ceil(triangles.size() * 6 + 8);
  if (edgeKeys_.size() < wanted) edgeKeys_.resize(wanted), edgeTriangles_.resize(wanted);
  const std::size_t mask = wanted - 1;
  std::fill_n(edgeKeys_.begin(), wanted, kFree);
  for (std::uint32_t f = 0; f < triangles.size(); ++f)
    for (std::size_t e = 0; e < 3; ++e) {
      const std::uint32_t a = triangles[f].vertex[(e + 1) % 3],
                          b = triangles[f].vertex[(e + 2) % 3];
      if (a == b) return false;
      const std::uint64_t key = edgeKey(a, b);
      std::size_t slot = slotOf(key, mask);
      for (; edgeKeys_[slot] != kFree; slot = (slot + 1) & mask)
        if (edgeKeys_[slot] == key) return false;
      edgeKeys_[slot] = key;
      edgeTriangles_[slot] = f;
    }
  for (LinkTriangle& t : triangles)
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
  for (std::uint32_t f = 0; f < triangleCount_; ++f)
    if (triangles_[f].holds(a, b)) return f;
  return kNoNeighbour;
}

std::uint32_t Link::localOf(VertexId vertex) const {
  const std::size_t slot = localSlot(vertex);
  return slot < locals_.size() && locals_[slot].generation == generation_ ? locals_[slot].id
                                                                          : kNoNeighbour;
}

void Link::place(std::span<const LatticePoint> points, const LatticePoint& centre) {
  for (std::size_t i = 0; i < vertexCount_; ++i) {
    const VertexId v = vertices_[i];
    assert(v == kGhost || v < points.size());
    const LatticePoint& p = v == kGhost ? centre : points[v];
    const auto along = [&](std::size_t a) { return static_cast<double>(p[a] - centre[a]); };
    putPair(&offsets_[i][0], Pair{along(0), along(1)});
    putPair(&offsets_[i][2], Pair{along(2), 0});
  }
  double furthest = -1;
  for (std::uint32_t f = 0; f < triangleCount_; ++f) {
    const LinkTriangle& t = triangles_[f];
    const Offset& i = offsets_[t.vertex[0]];
    const Offset& j = offsets_[t.vertex[1]];
    const Offset& k = offsets_[t.vertex[2]];
    const double times = t.ghost ? 3 : 2;
    const Pair flat = (pairAt(&i[0]) + pairAt(&j[0]) + pairAt(&k[0])) * times;
    const double up = (i[2] + j[2] + k[2]) * times;
    const Pair flatSquares = flat * flat;
    const double upSquare = up * up;
    const double squared = flatSquares[0] + flatSquares[1] + upSquare;
    // summed apart: each rounds in its own way
    const double oneMore = 1 + flatSquares[0] + flatSquares[1] + upSquare;
    middles_[f] = {{flat[0], flat[1], up}, log2Fixed(oneMore)};
    if (squared > furthest) furthest = squared, start_ = f;
  }
}

// Without branches on whether a triangle was seen: every third one was not.
void Link::traverse() {
  seen_.assign(triangleCount_, 0);
  std::uint32_t* const order = order_.data();
  std::uint32_t end = 0;
  order[end++] = start_;
  seen_[start_] = 1;
  for (std::uint32_t i = 0; i < end; ++i)
    for (const std::uint32_t next : triangles_[order[i]].neighbour) {
      assert(next < triangleCount_);  // close() saw to it
      order[end] = next;
      end += seen_[next] == 0;
      seen_[next] = 1;
    }
  reached_ = end;
}

bool Link::isSphere() {
  assert(triangleCount_ >= 4);  // close() saw to it
  const std::size_t faces = triangleCount_;
  if (faces % 2 != 0 || vertexCount_ + faces != faces / 2 * 3 + 2) return false;
  traverse();
  return reached_ == faces;
}

}  // namespace qtet
