#include "codec/mesh/growing_mesh.h"

#include <algorithm>
#include <cassert>

namespace qtet {
namespace {

// Squared differences are kept below 2^(2 * kSpreadBits), so that their sum over any star fits 64
// bits.
constexpr int kSpreadBits = 20;
// Room for cells that a star gets without being moved: a split brings a vertex of its link one or
// two.
constexpr std::uint32_t kSpareCells = 2;

}  // namespace

void GrowingMesh::start(int positionBits, std::span<const VertexId> frozen) {
  assert(states_.empty() && positionBits > 0 && positionBits <= kMaxPositionBits);
  spreadShift_ = std::max(0, positionBits - kSpreadBits);
  states_.assign(points.size(), {});
  marked_.assign(points.size(), 0);
  for (const VertexId v : frozen) marked_[v] = kFrozen;
  std::vector<std::uint32_t> cells(points.size(), kSpareCells);
  for (const Tetrahedron& t : tetrahedra)
    for (const VertexId v : t) ++cells[v];
  for (const Triangle& t : boundary)
    for (const VertexId v : t) ++cells[v];
  for (std::size_t v = 0; v < cells.size(); ++v) makeRoom(states_[v], cells[v]);
  for (std::uint32_t i = 0; i < tetrahedra.size(); ++i) addCell(i);
  for (std::uint32_t i = 0; i < boundary.size(); ++i) addCell(i | kBoundaryBit);
}

std::optional<CellRef> GrowingMesh::across(CellRef tetrahedron, std::size_t corner) const {
  assert(tetrahedron < tetrahedra.size() && corner < 4);
  const Tetrahedron& t = tetrahedra[tetrahedron];
  const std::array<VertexId, 4> last = withLast(t, corner);
  const std::span<const VertexId> face = std::span(last).first(3);
  const VertexId least =
      *std::ranges::min_element(face, {}, [&](VertexId v) { return states_[v].size; });
  for (const CellRef ref : star(least)) {
    if (ref & kBoundaryBit) break;  // they come last
    if (ref == tetrahedron) continue;
    const Tetrahedron& other = tetrahedra[ref];
    const auto has = [&](VertexId v) { return std::ranges::find(other, v) != other.end(); };
    if (std::ranges::all_of(face, has)) return ref;
  }
  return std::nullopt;
}

Slots GrowingMesh::slotsAfter(const Split& split, const Link& link) const {
  Slots after = next();
  after.vertices += static_cast<std::uint32_t>(split.k) - 1;
  for (const LocalCell& cell : split.deleted) {
    const bool ghost = std::ranges::any_of(
        cell, [&](LocalVertex v) { return !(v & kPreyBit) && link.vertices()[v] == kGhost; });
    ++(ghost ? after.triangles : after.tetrahedra);
  }
  return after;
}

VertexId GrowingMesh::newVertex() {
  points.emplace_back(), states_.emplace_back(), marked_.emplace_back();
  return static_cast<VertexId>(points.size() - 1);
}

void GrowingMesh::beginLevel(std::uint32_t level) {
  assert(level_ <= level && level > 0 && level <= kMaxLevels);
  level_ = level;
  levelVertices_ = static_cast<std::uint32_t>(points.size());
}

// A cell of a high slot goes to the end, boundary triangles last: a step or two from there.
void GrowingMesh::add(VertexId v, CellRef cell) {
  State& s = states_[v];
  if (s.size == s.units * StarPool::kUnit) makeRoom(s, s.size + s.size / 8 + kSpareCells);
  assert(s.size < s.units * StarPool::kUnit);
  CellRef* const cells = pool_.at(s.first);
  std::uint32_t at = s.size++;
  for (; at > 0 && cells[at - 1] > cell; --at) cells[at] = cells[at - 1];
  cells[at] = cell;
  s.onBoundary |= (cell & kBoundaryBit) != 0;
}

// Moves the star into a new run with room for `cells` cells.
void GrowingMesh::makeRoom(State& state, std::uint32_t cells) {
  assert(state.size <= cells);
  const std::uint32_t units = StarPool::unitsFor(cells);
  const std::uint32_t first = pool_.take(units);
  std::copy_n(pool_.at(state.first), state.size, pool_.at(first));
  if (state.units > 0) pool_.give(state.first, state.units);
  state.first = first;
  state.units = units;
}

void GrowingMesh::reserve(const Slots& total) {
  points.reserve(total.vertices);
  states_.reserve(total.vertices);
  marked_.reserve(total.vertices);
  tetrahedra.reserve(total.tetrahedra);
  boundary.reserve(total.triangles);
  pool_.reserve(static_cast<std::size_t>(starCells(total)));
}

std::uint64_t GrowingMesh::starCells(const Slots& total) {
  // of a star's last unit, and its share of runs that were given back: 4 to 9 measured
  constexpr std::uint64_t kUnusedCells = 10;
  return std::uint64_t{4} * total.tetrahedra + std::uint64_t{3} * total.triangles +
         kUnusedCells * total.vertices;
}

std::uint64_t GrowingMesh::roomFor(const Slots& total) {
  constexpr std::uint64_t kVertex = sizeof(LatticePoint) + sizeof(State) + sizeof(std::uint16_t);
  return kVertex * total.vertices + sizeof(Tetrahedron) * std::uint64_t{total.tetrahedra} +
         sizeof(Triangle) * std::uint64_t{total.triangles} + sizeof(CellRef) * starCells(total);
}

// Adds the edges of one cell to the spreads of its corners, of which a boundary triangle has three.
template <bool kShifted, std::size_t kCorners>
void GrowingMesh::measure(std::span<const VertexId, kCorners> corners) {
  std::array<std::array<std::uint64_t, 3>, kCorners> sums{};
  for (std::size_t i = 1; i < kCorners; ++i)
    for (std::size_t j = 0; j < i; ++j)
      for (std::size_t a = 0; a < 3; ++a) {
        const std::int32_t here = points[corners[i]][a], there = points[corners[j]][a];
        const std::uint64_t to = squared<kShifted>(here - there);
        sums[i][a] += to;
        sums[j][a] += kShifted ? squared<kShifted>(there - here) : to;  // a shift rounds down
      }
  for (std::size_t i = 0; i < kCorners; ++i) {
    Spread& s = states_[corners[i]].spread;
    s.edges += kCorners - 1;
    for (std::size_t a = 0; a < 3; ++a) s.squares[a] += sums[i][a];
  }
}

void GrowingMesh::addCell(CellRef ref) {
  const auto addTo = [&](auto corners) {
    for (const VertexId v : corners) add(v, ref);
    spreadShift_ == 0 ? measure<false>(corners) : measure<true>(corners);
  };
  if (ref & kBoundaryBit)
    addTo(std::span<const VertexId, 3>(boundary[ref & ~kBoundaryBit]));
  else
    addTo(std::span<const VertexId, 4>(tetrahedra[ref]));
}

// The edges from the link to the fused vertex go to the prey vertices. Each label's share at a
// vertex is the number of its triangles there. Labels that are not there count 0 times: to ask
// would cost more.
template <bool kShifted>
void GrowingMesh::moveEdges(const Link& link, std::span<const VertexId> prey) {
  std::array<Spread, 4> ofPrey{};
  std::array<LatticePoint, 4> places{};
  for (std::size_t i = 0; i < prey.size(); ++i) places[i] = points[prey[i]];
  for (std::uint32_t local = 0; local < link.vertices().size(); ++local) {
    const VertexId x = link.vertices()[local];
    if (x == kGhost) continue;
    const Link::LabelCounts counts = link.labelsRound(local);
    const LatticePoint place = points[x];
    std::array<std::uint64_t, 3> now{};
    std::uint64_t all = 0;
    for (std::size_t i = 0; i < prey.size(); ++i) {
      const std::uint64_t n = Link::countOf(counts, i);
      all += n;
      for (std::size_t a = 0; a < 3; ++a) {
        const std::uint64_t edges = n * squared<kShifted>(place[a] - places[i][a]);
        now[a] += edges;
        ofPrey[i].squares[a] += kShifted ? n * squared<kShifted>(places[i][a] - place[a]) : edges;
      }
      ofPrey[i].edges += static_cast<std::uint32_t>(n);
    }
    Spread& ofLink = states_[x].spread;
    for (std::size_t a = 0; a < 3; ++a)
      ofLink.squares[a] += now[a] - all * squared<kShifted>(place[a] - fused_[a]);
  }
  for (std::size_t i = 0; i < prey.size(); ++i) states_[prey[i]].spread = ofPrey[i];
}

// A star's cells and vertices lie scattered in memory. Prefetching all before the first is read
// halves the time of a refinement.
bool GrowingMesh::enter(VertexId v, Link& link) {
  link.clear(points.size());
  const std::span<const CellRef> star = this->star(v);
  entered_.assign(star.begin(), star.end());
  for (const CellRef ref : star) expectCell(ref);
  places_.resize(star.size());
  turned_.resize(star.size());
  bool whole = true;
  for (std::size_t i = 0; i < star.size(); ++i) {
    const std::array<VertexId, 4> c = cell(star[i]);
    const auto is = [&](std::size_t at) { return static_cast<std::size_t>(c[at] == v); };
    const std::size_t index = (is(1) | is(3)) + 2 * (is(2) | is(3));
    whole &= is(0) + is(1) + is(2) + is(3) == 1;
    places_[i] = static_cast<std::uint8_t>(index);
    const std::array<VertexId, 4> turned = withLast(c, index);
    turned_[i] = {turned[0], turned[1], turned[2]};
  }
  if (!whole) return false;
  for (const Triangle& t : turned_)
    for (const VertexId w : t) link.expect(w);
  link.add(turned_);
  for (const VertexId w : link.vertices())
    if (w != kGhost) {
      prefetch(&points[w]);
      prefetch(&states_[w].spread);
      prefetch(&states_[w].first);  // in every second state on another cache line
      mark(w);
    }
  mark(v);
  if (!link.close()) return false;
  for (const VertexId w : link.vertices())  // where apply() will add cells
    if (w != kGhost) prefetch(pool_.at(states_[w].first) + states_[w].size - 1);
  link.place(points, points[v]);
  return link.isSphere();
}

// Deals the cells of the star out to the prey vertices, in order.
void GrowingMesh::moveStar(const Link& link, std::span<const VertexId> prey) {
  std::array<std::uint32_t, 4> cellsOf{};
  for (const LinkTriangle& t : link.triangles()) ++cellsOf[t.label & 3];
  for (std::size_t i = 0; i < prey.size(); ++i) {
    State& s = states_[prey[i]];
    s.size = 0;
    if (StarPool::unitsFor(cellsOf[i] + kSpareCells) != s.units)
      makeRoom(s, cellsOf[i] + kSpareCells);
  }
  std::array<CellRef*, 4> end{};
  for (std::size_t i = 0; i < prey.size(); ++i) end[i] = pool_.at(states_[prey[i]].first);
  std::array<CellRef, 4> any{};
  for (std::size_t f = 0; f < entered_.size(); ++f) {
    const std::size_t label = link.triangles()[f].label & 3;
    const CellRef ref = entered_[f];
    any[label] |= ref;
    *end[label]++ = ref;
    if (ref & kBoundaryBit)
      boundary[ref & ~kBoundaryBit][places_[f]] = prey[label];
    else
      tetrahedra[ref][places_[f]] = prey[label];
  }
  for (std::size_t i = 0; i < prey.size(); ++i) {
    states_[prey[i]].size = cellsOf[i];
    states_[prey[i]].onBoundary = (any[i] & kBoundaryBit) != 0;
  }
}

void GrowingMesh::apply(VertexId v, const Link& link, const Split& split) {
  assert(split.k >= 2 && split.k <= 4);
  assert(link.triangles().size() == entered_.size() && star(v).size() == entered_.size());
  fused_ = points[v];
  std::array<VertexId, 4> all{v};
  const auto prey = std::span(all).first(static_cast<std::size_t>(split.k));
  for (std::size_t i = 0; i < prey.size(); ++i) {
    if (i > 0) prey[i] = newVertex();
    points[prey[i]] = split.points[i];
    states_[prey[i]].born = marked_[prey[i]] = static_cast<std::uint16_t>(level_);
  }
  moveStar(link, prey);
  spreadShift_ == 0 ? moveEdges<false>(link, prey) : moveEdges<true>(link, prey);
  for (const LocalCell& local : split.deleted) {
    std::array<VertexId, 4> c{};
    for (std::size_t i = 0; i < 4; ++i)
      c[i] = local[i] & kPreyBit ? prey[local[i] & 3] : link.vertices()[local[i]];
    const auto ghost = static_cast<std::size_t>(std::ranges::find(c, kGhost) - c.begin());
    if (ghost == 4) {
      tetrahedra.push_back(c);
      addCell(static_cast<CellRef>(tetrahedra.size() - 1));
    } else {
      c = withLast(c, ghost);
      boundary.push_back({c[0], c[1], c[2]});
      addCell(static_cast<CellRef>(boundary.size() - 1) | kBoundaryBit);
    }
  }
}

}  // namespace qtet
