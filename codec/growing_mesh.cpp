#include "codec/growing_mesh.h"

#include <algorithm>

namespace qtet {
namespace {

// Squared differences are kept below 2^(2 * kSpreadBits), so that their sum over any star fits 64 bits.
constexpr int kSpreadBits = 20;
// Room for cells that a star gets without being moved: a split brings a vertex of its link one or two.
constexpr std::uint32_t kSpareCells = 2;

}  // namespace

void GrowingMesh::start(int positionBits) {
  spreadShift_ = std::max(0, positionBits - kSpreadBits);
  states_.assign(points.size(), {});
  marked_.assign(points.size(), 0);
  std::vector<std::uint32_t> cells(points.size(), kSpareCells);
  for (const Tetrahedron& t : tetrahedra)
    for (const VertexId v : t) ++cells[v];
  for (const Triangle& t : boundary)
    for (const VertexId v : t) ++cells[v];
  for (std::size_t v = 0; v < cells.size(); ++v) makeRoom(states_[v], cells[v]);
  for (std::uint32_t i = 0; i < tetrahedra.size(); ++i) addCell(i);
  for (std::uint32_t i = 0; i < boundary.size(); ++i) addCell(i | kBoundaryBit);
  next_ = {static_cast<std::uint32_t>(points.size()), static_cast<std::uint32_t>(tetrahedra.size()), static_cast<std::uint32_t>(boundary.size())};
}

void GrowingMesh::continueAt(const Slots& first, const Slots& end) {
  next_ = first;
  if (points.size() < end.vertices) points.resize(end.vertices, kHolePoint), states_.resize(end.vertices), marked_.resize(end.vertices);
  if (tetrahedra.size() < end.tetrahedra) tetrahedra.resize(end.tetrahedra, kHoleTetrahedron);
  if (boundary.size() < end.triangles) boundary.resize(end.triangles, kHoleTriangle);
}

Slots GrowingMesh::slotsAfter(const Split& split, const Link& link) const {
  Slots after = next_;
  after.vertices += static_cast<std::uint32_t>(split.k) - 1;
  for (const LocalCell& cell : split.deleted) {
    const bool ghost = std::ranges::any_of(cell, [&](LocalVertex v) { return !(v & kPreyBit) && link.vertices()[v] == kGhost; });
    ++(ghost ? after.triangles : after.tetrahedra);
  }
  return after;
}

VertexId GrowingMesh::newVertex() {
  if (next_.vertices == points.size()) points.emplace_back(), states_.emplace_back(), marked_.emplace_back();
  return next_.vertices++;
}

void GrowingMesh::beginLevel(std::uint32_t level) {
  level_ = level;
  levelVertices_ = static_cast<std::uint32_t>(points.size());
}

// A cell of a high slot goes to the end, boundary triangles last: a step or two from there.
void GrowingMesh::add(VertexId v, CellRef cell) {
  State& s = states_[v];
  if (s.size == s.units * StarPool::kUnit) makeRoom(s, s.size + s.size / 8 + kSpareCells);
  CellRef* const cells = pool_.at(s.first);
  std::uint32_t at = s.size++;
  for (; at > 0 && cells[at - 1] > cell; --at) cells[at] = cells[at - 1];
  cells[at] = cell;
  s.onBoundary |= (cell & kBoundaryBit) != 0;
}

// A run of its own for what the star holds, and for so many cells.
void GrowingMesh::makeRoom(State& state, std::uint32_t cells) {
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
  constexpr std::uint64_t kUnusedCells = 10;  // of a star's last unit, and its share of runs that were given back: 4 to 9 measured
  return std::uint64_t{4} * total.tetrahedra + std::uint64_t{3} * total.triangles + kUnusedCells * total.vertices;
}

std::uint64_t GrowingMesh::roomFor(const Slots& total) {
  constexpr std::uint64_t kVertex = sizeof(LatticePoint) + sizeof(State) + sizeof(std::uint16_t);
  return kVertex * total.vertices + sizeof(Tetrahedron) * std::uint64_t{total.tetrahedra} + sizeof(Triangle) * std::uint64_t{total.triangles} +
         sizeof(CellRef) * starCells(total);
}

void GrowingMesh::measure(VertexId v, VertexId other) {
  Spread& s = states_[v].spread;
  for (std::size_t a = 0; a < 3; ++a) {
    const std::int64_t d = (points[v][a] - points[other][a]) >> spreadShift_;
    s.squares[a] += static_cast<std::uint64_t>(d * d);
  }
}

void GrowingMesh::addCell(CellRef ref) {
  const std::array<VertexId, 4> c = cell(ref);
  const std::size_t corners = c[3] == kGhost ? 3 : 4;
  for (std::size_t i = 0; i < corners; ++i) {
    add(c[i], ref);
    states_[c[i]].spread.edges += static_cast<std::uint32_t>(corners - 1);
    for (std::size_t j = 0; j < corners; ++j)
      if (i != j) measure(c[i], c[j]);
  }
}

// The edges from the link to the fused vertex go to the prey vertices: as many as there are triangles of each label at a vertex.
void GrowingMesh::moveEdges(const Link& link, std::span<const VertexId> prey) {
  const LatticePoint& fused = fused_;
  corners_.assign(link.vertices().size(), {});
  for (const LinkTriangle& t : link.triangles())
    for (const std::uint32_t local : t.vertex) ++corners_[local][t.label];
  for (std::size_t local = 0; local < corners_.size(); ++local) {
    const VertexId x = link.vertices()[local];
    if (x == kGhost) continue;
    Spread& ofLink = states_[x].spread;
    for (std::size_t i = 0; i < prey.size(); ++i) {
      const std::uint64_t n = corners_[local][i];
      if (n == 0) continue;
      Spread& ofPrey = states_[prey[i]].spread;
      ofPrey.edges += static_cast<std::uint32_t>(n);
      for (std::size_t a = 0; a < 3; ++a) {
        const std::int64_t before = (points[x][a] - fused[a]) >> spreadShift_;
        const std::int64_t now = (points[x][a] - points[prey[i]][a]) >> spreadShift_;
        const std::int64_t back = (points[prey[i]][a] - points[x][a]) >> spreadShift_;
        ofLink.squares[a] += n * static_cast<std::uint64_t>(now * now - before * before);
        ofPrey.squares[a] += n * static_cast<std::uint64_t>(back * back);
      }
    }
  }
}

// A star's cells and vertices lie anywhere in memory: all are asked for before the first is waited for, which halves the time of a refinement.
bool GrowingMesh::enter(VertexId v, Link& link) {
  link.clear(points.size());
  const std::span<const CellRef> star = this->star(v);
  entered_.assign(star.begin(), star.end());
  cells_.resize(star.size());
  for (std::size_t i = 0; i < star.size(); ++i) cells_[i] = cell(star[i]);
  for (const auto& c : cells_)
    for (const VertexId w : c)
      if (w != kGhost) link.expect(w);
  for (const auto& c : cells_) {
    const std::size_t index = (c[1] == v ? 1u : 0u) + (c[2] == v ? 2u : 0u) + (c[3] == v ? 3u : 0u);
    if (index > 3 || c[index] != v) return false;
    const std::array<VertexId, 4> turned = withLast(c, index);
    link.add(turned[0], turned[1], turned[2]);
  }
  for (const VertexId w : link.vertices())
    if (w != kGhost) {
      __builtin_prefetch(&points[w]);
      __builtin_prefetch(&states_[w]);
      marked_[w] = static_cast<std::uint16_t>(level_);
    }
  marked_[v] = static_cast<std::uint16_t>(level_);
  if (!link.close()) return false;
  link.place(points, points[v]);
  return link.isSphere();
}

void GrowingMesh::apply(VertexId v, const Link& link, const Split& split) {
  for (const LocalCell& local : split.deleted)
    for (const LocalVertex x : local)
      if (!(x & kPreyBit) && link.vertices()[x] != kGhost) {
        const State& s = states_[link.vertices()[x]];
        __builtin_prefetch(pool_.at(s.first) + s.size);
      }
  fused_ = points[v];
  std::array<VertexId, 4> prey{v};
  std::array<std::uint32_t, 4> cellsOf{};
  for (const LinkTriangle& t : link.triangles()) ++cellsOf[t.label];
  for (std::size_t i = 0; i < static_cast<std::size_t>(split.k); ++i) {
    if (i > 0) prey[i] = newVertex();
    points[prey[i]] = split.points[i];
    State& s = states_[prey[i]];
    s.size = 0;
    if (StarPool::unitsFor(cellsOf[i] + kSpareCells) != s.units) makeRoom(s, cellsOf[i] + kSpareCells);
    s.spread = {};
    s.onBoundary = false;
    s.born = marked_[prey[i]] = static_cast<std::uint16_t>(level_);
  }
  for (std::size_t f = 0; f < entered_.size(); ++f) {
    const VertexId w = prey[link.triangles()[f].label];
    if (w != v) {
      if (entered_[f] & kBoundaryBit)
        std::ranges::replace(boundary[entered_[f] & ~kBoundaryBit], v, w);
      else
        std::ranges::replace(tetrahedra[entered_[f]], v, w);
    }
    add(w, entered_[f]);
  }
  moveEdges(link, std::span(prey).first(static_cast<std::size_t>(split.k)));
  for (const LocalCell& local : split.deleted) {
    std::array<VertexId, 4> c{};
    for (std::size_t i = 0; i < 4; ++i) c[i] = local[i] & kPreyBit ? prey[local[i] & 3] : link.vertices()[local[i]];
    const auto ghost = static_cast<std::size_t>(std::ranges::find(c, kGhost) - c.begin());
    if (ghost == 4) {
      put(tetrahedra, next_.tetrahedra, c);
      addCell(next_.tetrahedra++);
    } else {
      c = withLast(c, ghost);
      put(boundary, next_.triangles, Triangle{c[0], c[1], c[2]});
      addCell(next_.triangles++ | kBoundaryBit);
    }
  }
}

}  // namespace qtet
