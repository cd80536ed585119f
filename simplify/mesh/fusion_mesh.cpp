#include "simplify/mesh/fusion_mesh.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>

#include "codec/mesh/growing_mesh.h"
#include "codec/mesh/link.h"
#include "proto/limits.h"
#include "simplify/mesh/large_pages.h"
#include "simplify/mesh/workers.h"

namespace qtet {
namespace {

// Room for each cell of the input, boundary triangles among them. It is for the cells that fusions
// affect until 1 % is left, and for the stars with their gaps. Seen were 3 and 5.6; with more the
// arrays move.
constexpr std::size_t kAffectedACell = 4;
constexpr std::size_t kPoolACell = 6;

}  // namespace

FusionMesh::FusionMesh(const LatticeMesh& mesh, std::size_t regionField, Workers* workers)
    : regionField_(regionField),
      firstGhost_(static_cast<CellId>(mesh.tetrahedra.size())),
      liveTetrahedra_(mesh.tetrahedra.size()) {
  assert(mesh.lattice.bits > 0 && mesh.lattice.bits <= kMaxPositionBits);
  assert(mesh.values.size() == mesh.fields.size());
  assert(regionField == kNoRegions || isCellField(mesh.fields[regionField]));
  history_.lattice = mesh.lattice;
  history_.fields = mesh.fields;
  reserve(mesh);
  history_.points.assign(mesh.points.begin(), mesh.points.end());
  for (std::size_t f = 0; f < mesh.values.size(); ++f) {
    // a part has no values of cells but its regions (mesh_part.cpp)
    assert((isCellField(mesh.fields[f]) && mesh.values[f].empty()) ||
           mesh.values[f].size() ==
               mesh.fields[f].components *
                   (isCellField(mesh.fields[f]) ? mesh.tetrahedra.size() : mesh.points.size()));
    history_.values[f].assign(mesh.values[f].begin(), mesh.values[f].end());
  }
  history_.cells.assign(mesh.tetrahedra.begin(), mesh.tetrahedra.end());
  onBoundary_.assign(mesh.points.size(), 0);
  for (const Triangle& t : mesh.boundary) {
    history_.cells.push_back({t[0], t[1], t[2], kGhost});
    for (const VertexId v : t) onBoundary_[v] = 1;
  }
  history_.live.assign(history_.cells.size(), 1);
  aliveVertex_.assign(mesh.points.size(), 1);
  planes_.resize(mesh.boundary.size());
  for (CellId c = firstGhost_; c < history_.cells.size(); ++c) findPlane(c);
  buildStars();
  findSingular(workers);
  if (hasRegions()) findInterfaces();
}

// Reserves room for all that will ever be where a bound is known, else for what is likely. So
// arrays do not move while they grow, and the system never hands out what stays unused.
void FusionMesh::reserve(const LatticeMesh& mesh) {
  // each fusion leaves a vertex less
  const std::size_t fusions = mesh.points.size(), vertices = mesh.points.size() + fusions;
  const std::size_t cells = mesh.tetrahedra.size() + mesh.boundary.size();
  history_.points.reserve(vertices);
  history_.values.resize(mesh.values.size());
  for (std::size_t f = 0; f < mesh.fields.size(); ++f)
    history_.values[f].reserve(isCellField(mesh.fields[f]) ? 0
                                                           : vertices * mesh.fields[f].components);
  history_.fusions.reserve(fusions);
  history_.deletedCells.reserve(cells);
  history_.affectedCells.reserve(kAffectedACell * cells),
      history_.affectedLabels.reserve(kAffectedACell * cells);
  for (auto* flags : {&aliveVertex_, &onBoundary_, &singular_}) flags->reserve(vertices);
  if (hasRegions()) onInterface_.reserve(vertices);
  stars_.reserve(vertices);
  pool_.reserve(kPoolACell * cells);
  history_.cells.reserve(cells), history_.live.reserve(cells);
  useLargePages(history_.points), useLargePages(history_.fusions),
      useLargePages(history_.deletedCells), useLargePages(history_.affectedCells);
  for (const auto& values : history_.values) useLargePages(values);
  useLargePages(stars_), useLargePages(pool_), useLargePages(history_.cells);
}

void FusionMesh::buildStars() {
  stars_.assign(history_.points.size(), {});
  for (const auto& c : history_.cells)
    for (const VertexId v : c)
      if (v != kGhost) ++stars_[v].size;
  for (StarRange& s : stars_) {
    s.first = livePool_;
    livePool_ += s.size;
    s.size = 0;
  }
  pool_.resize(livePool_);
  const auto add = [&](CellId c) {
    for (const VertexId v : history_.cells[c])
      if (v != kGhost) pool_[stars_[v].first + stars_[v].size++] = c;
  };
  for (CellId c = firstGhost_; c < history_.cells.size(); ++c) add(c);
  for (StarRange& s : stars_) s.ghosts = s.size;
  for (CellId c = 0; c < firstGhost_; ++c) add(c);
}

void FusionMesh::findSingular(Workers* workers) {
  constexpr std::size_t kGrain = 1024;
  constexpr VertexId kAhead = 4;
  singular_.assign(history_.points.size(), 0);
  struct alignas(64) Own {  // in cache lines of its own
    Link link;
  };
  std::vector<Own> own(workers ? workers->count() : 1);
  const auto ask = [&](std::size_t worker, std::size_t i) {
    const auto v = static_cast<VertexId>(i);
    if (i + kAhead < singular_.size()) prefetchStar(v + kAhead);
    Link& link = own[worker].link;
    link.clear(singular_.size());
    for (const CellId c : star(v)) {
      const auto turned = withLast(cell(c), onlyCorner(cornersThatAre(cell(c), v)));
      link.add(turned[0], turned[1], turned[2]);
    }
    singular_[i] = !(link.close() && link.isSphere());
  };
  forEach(workers, singular_.size(), kGrain, ask);
  hasSingular_ = std::ranges::find(singular_, 1) != singular_.end();
}

void FusionMesh::keep(std::span<const VertexId> vertices) {
  for (const VertexId v : vertices) {
    assert(v < singular_.size());
    singular_[v] = 1;
  }
  hasSingular_ |= !vertices.empty();
}

void FusionMesh::findInterfaces() {
  onInterface_.assign(history_.points.size(), 0);
  std::vector<std::int64_t> first(history_.points.size(), kOutside);
  for (CellId c = 0; c < firstGhost_; ++c)
    for (const VertexId v : history_.cells[c]) {
      if (first[v] == kOutside) first[v] = region(c);
      onInterface_[v] |= first[v] != region(c);
    }
}

// The first in this order that holds takes the fewest bits.
FusionMesh::Placed FusionMesh::placed(const Prey& prey, const LatticePoint& point) const {
  std::array<LatticePoint, 4> at{};
  for (std::size_t i = 0; i < prey.k; ++i) at[i] = history_.points[prey.vertex[i]];
  for (std::uint8_t i = 0; i < prey.k; ++i)
    if (at[i] == point) return {Placement::kAtPrey, i};
  if (middle(std::span(at).first(prey.k)) == point) return {Placement::kMiddle, 0};
  for (std::uint8_t i = 0; i < 2 && prey.k == 2; ++i)
    if (quarter(at[i], at[1 - i]) == point) return {Placement::kQuarter, i};
  return {Placement::kFree, 0};
}

// All of a record that addRecord() has left open.
void FusionMesh::fillRecord(Fusion& record, const Prey& prey, const Placed& placed,
                            const Star& star) {
  record.k = prey.k;
  record.placement = placed.placement;
  record.prey = prey.vertex;
  const std::uint8_t first = placed.first;
  std::swap(record.prey[0], record.prey[first]);
  std::ranges::copy(star.affected, &history_.affectedCells[record.firstAffected]);
  std::ranges::transform(star.labels, &history_.affectedLabels[record.firstAffected],
                         [&](std::uint8_t label) {
                           return label == first ? std::uint8_t{0} : label == 0 ? first : label;
                         });
  std::ranges::copy(star.deleted, history_.deletedCells.begin() +
                                      static_cast<std::ptrdiff_t>(record.firstDeleted));
}

// The last ghost takes a ghost's place, and the last cell takes that of what is now the hole.
void FusionMesh::removeFromStar(VertexId v, CellId c) {
  StarRange& range = stars_[v];
  std::uint32_t hole = placeInStar(v, c);
  assert(aliveVertex_[v] && hole < range.size);
  assert(pool_[range.first + hole] == c);
  if (isGhost(c)) {
    moveInStar(v, --range.ghosts, hole);
    hole = range.ghosts;
  }
  moveInStar(v, --range.size, hole);
}

std::uint32_t FusionMesh::placeInStar(VertexId v, CellId c) {
  const auto cells = star(v);
  if (cells.size() <= kHubCells) {
    const auto first = cells.begin() + (isGhost(c) ? 0 : stars_[v].ghosts);
    return static_cast<std::uint32_t>(std::find(first, cells.end(), c) - cells.begin());
  }
  Places& places = placesInHub_[v];
  if (places.empty())
    for (std::uint32_t i = 0; i < cells.size(); ++i) places[cells[i]] = i;
  return places.extract(c).mapped();
}

void FusionMesh::moveInStar(VertexId v, std::uint32_t from, std::uint32_t to) {
  assert(to <= from);
  if (from == to) return;
  CellId* cells = &pool_[stars_[v].first];
  cells[to] = cells[from];
  if (stars_[v].size < kHubCells) return;
  if (const auto hub = placesInHub_.find(v); hub != placesInHub_.end()) hub->second[cells[to]] = to;
}

void FusionMesh::findPlane(CellId ghost) {
  assert(isGhost(ghost) && history_.cells[ghost][3] == kGhost);
  const auto& cell = history_.cells[ghost];
  const Vector3 a = position(cell[0]), normal = cross(position(cell[1]) - a, position(cell[2]) - a);
  const double squared = dot(normal, normal);
  planes_[ghost - firstGhost_] = {normal, squared > 0 ? 1 / std::sqrt(squared) : 0};
}

VertexId FusionMesh::fuse(const Prey& prey, const FusedVertex& what, const Star& star,
                          std::uint32_t level) {
  assert(prey.k >= 2 && prey.k <= 4 && level < kMaxLevels);
  assert(star.labels.size() == star.affected.size());
  assert(((what.point[0] | what.point[1] | what.point[2]) >> latticeBits()) == 0);
  Fusion& record = addRecord(star, level);
  const VertexId fused = record.fused;
  const std::uint64_t firstOfStar = pool_.size();
  pool_.resize(pool_.size() + star.affected.size());
  livePool_ += star.affected.size();
  setValues(fused, what.values);
  for (const VertexId v : star.link)
    if (v != kGhost) prefetchList(v);
  fillRecord(record, prey, placed(prey, what.point), star);
  history_.points[fused] = what.point;
  fuseCells(prey, star, fused);
  stars_[fused] = addStar(firstOfStar, star.affected);
  if (pool_.size() > 2 * livePool_ + 4096) compactPool();
  return fused;
}

// A record that says where its cells begin, with room for them and for the fused vertex.
Fusion& FusionMesh::addRecord(const Star& star, std::uint32_t level) {
  Fusion& record = history_.fusions.emplace_back();
  record.level = level;
  record.fused = static_cast<VertexId>(history_.points.size());
  record.firstAffected = history_.affectedCells.size();
  record.affectedCount = static_cast<std::uint32_t>(star.affected.size());
  record.firstDeleted = history_.deletedCells.size();
  record.deletedCount = static_cast<std::uint32_t>(star.deleted.size());
  history_.affectedCells.resize(record.firstAffected + record.affectedCount);
  history_.affectedLabels.resize(record.firstAffected + record.affectedCount);
  history_.deletedCells.resize(record.firstDeleted + record.deletedCount);
  const std::size_t vertices = history_.points.size() + 1;
  history_.points.resize(vertices);
  for (std::size_t f = 0; f < history_.fields.size(); ++f)
    if (!isCellField(history_.fields[f]))
      history_.values[f].resize(vertices * history_.fields[f].components);
  onBoundary_.resize(vertices), singular_.resize(vertices), aliveVertex_.resize(vertices),
      stars_.resize(vertices);
  if (hasRegions()) onInterface_.resize(vertices);
  return record;
}

// The star's cells that stay get the fused vertex, and those that go leave the stars of the others.
void FusionMesh::fuseCells(const Prey& prey, const Star& star, VertexId fused) {
  assert(stars_.size() == vertexSlots() && aliveVertex_.size() == vertexSlots());
  for (const VertexId v : prey.vertices()) {
    assert(aliveVertex_[v] && !singular(v));
    onBoundary_[fused] |= onBoundary_[v];
    if (hasRegions()) onInterface_[fused] |= onInterface_[v];
    aliveVertex_[v] = 0;
    assert(stars_[v].size <= livePool_);
    livePool_ -= stars_[v].size;
    stars_[v].size = stars_[v].ghosts = 0;
  }
  for (std::size_t i = 0; i < star.affected.size(); ++i) {
    const CellId c = star.affected[i];
    assert(history_.live[c] && star.labels[i] < prey.k);
    auto& cell = history_.cells[c];
    cell[onlyCorner(cornersThatAre(cell, prey.vertex[star.labels[i]]))] = fused;
    if (isGhost(c)) findPlane(c);
  }
  for (const CellId c : star.deleted) {
    assert(history_.live[c]);
    history_.live[c] = 0;
    liveTetrahedra_ -= !isGhost(c);
    const auto& cell = history_.cells[c];
    unsigned fusing = 0;
    for (const VertexId v : prey.vertices()) fusing |= cornersThatAre(cell, v);
    assert(std::popcount(fusing) >= 2);
    const OtherCorners& others = kOtherCorners[fusing];
    for (std::size_t i = 0; i < others.count; ++i)
      if (const VertexId v = cell[others.corner[i]]; v != kGhost) removeFromStar(v, c), --livePool_;
  }
  aliveVertex_[fused] = 1;
}

void FusionMesh::setValues(VertexId fused, std::span<const std::int32_t> values) {
  for (std::size_t f = 0; f < history_.fields.size(); ++f) {
    if (isCellField(history_.fields[f])) continue;
    const std::size_t n = history_.fields[f].components;
    assert(values.size() >= n && history_.values[f].size() == (fused + std::size_t{1}) * n);
    std::ranges::copy(values.first(n), &history_.values[f][fused * n]);
    values = values.subspan(n);
  }
  assert(values.empty());
}

// The fused vertex's, ghosts first.
FusionMesh::StarRange FusionMesh::addStar(std::uint64_t first, std::span<const CellId> cells) {
  std::size_t ghosts = 0, at = cells.size();
  for (const CellId c : cells) pool_[first + (isGhost(c) ? ghosts++ : --at)] = c;
  assert(ghosts == at);
  return {first, static_cast<std::uint32_t>(cells.size()), static_cast<std::uint32_t>(ghosts)};
}

// In place: stars lie in the order of their vertices.
void FusionMesh::compactPool() {
  std::uint64_t end = 0;
  for (StarRange& s : stars_) {
    assert(s.first >= end);
    if (s.first != end)
      std::copy_n(pool_.begin() + static_cast<std::ptrdiff_t>(s.first), s.size,
                  pool_.begin() + static_cast<std::ptrdiff_t>(end));
    s.first = end;
    end += s.size;
  }
  assert(end == livePool_);
  pool_.resize(end);
  giveBackRoom(pool_);
}

FusionHistory FusionMesh::takeHistory(std::uint32_t levels) {
  assert(history_.fusions.empty() || history_.fusions.back().level < levels);
  history_.levels = levels;
  return std::move(history_);
}

}  // namespace qtet
