#include "simplify/fusion_mesh.h"

#include <algorithm>
#include <cmath>

#include "codec/boundary.h"
#include "simplify/sphere_test.h"
#include "simplify/workers.h"

namespace qtet {

FusionMesh::FusionMesh(const LatticeMesh& mesh, std::size_t regionField, Workers* workers)
    : regionField_(regionField), firstGhost_(static_cast<CellId>(mesh.tetrahedra.size())), liveTetrahedra_(mesh.tetrahedra.size()) {
  history_.lattice = mesh.lattice;
  history_.fields = mesh.fields;
  history_.points = mesh.points;
  history_.values = mesh.values;
  history_.cells.reserve(mesh.tetrahedra.size() + mesh.boundary.size());
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
  std::vector<SphereTest> tests(workers ? workers->count() : 1, SphereTest(history_.points.size()));
  const auto ask = [&](std::size_t worker, std::size_t i) {
    const auto v = static_cast<VertexId>(i);
    if (i + kAhead < singular_.size()) prefetchStar(v + kAhead);
    singular_[i] = !tests[worker].isLinkSphere(v, star(v), history_.cells);
  };
  if (workers)
    workers->forEach(singular_.size(), kGrain, ask);
  else
    for (std::size_t i = 0; i < singular_.size(); ++i) ask(0, i);
  hasSingular_ = std::ranges::find(singular_, 1) != singular_.end();
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

void FusionMesh::record(const Prey& prey, const Placed& placed, const Star& star, std::uint32_t level) {
  Fusion record;
  record.k = prey.k;
  record.placement = placed.placement;
  record.level = level;
  record.fused = static_cast<VertexId>(history_.points.size());
  record.prey = prey.vertex;
  const std::uint8_t first = placed.first;
  std::swap(record.prey[0], record.prey[first]);
  record.firstAffected = history_.affectedCells.size();
  record.affectedCount = static_cast<std::uint32_t>(star.affected.size());
  record.firstDeleted = history_.deletedCells.size();
  record.deletedCount = static_cast<std::uint32_t>(star.deleted.size());
  history_.fusions.push_back(record);
  history_.affectedCells.insert(history_.affectedCells.end(), star.affected.begin(), star.affected.end());
  for (const std::uint8_t label : star.labels)
    history_.affectedLabels.push_back(label == first ? std::uint8_t{0} : label == 0 ? first : label);
  history_.deletedCells.insert(history_.deletedCells.end(), star.deleted.begin(), star.deleted.end());
}

// The last ghost takes a ghost's place, and the last cell takes that of what is now the hole.
void FusionMesh::removeFromStar(VertexId v, CellId c) {
  StarRange& range = stars_[v];
  std::uint32_t hole = placeInStar(v, c);
  if (isGhost(c)) {
    moveInStar(v, --range.ghosts, hole);
    hole = range.ghosts;
  }
  moveInStar(v, --range.size, hole);
  --livePool_;
}

std::uint32_t FusionMesh::placeInStar(VertexId v, CellId c) {
  const auto cells = star(v);
  if (cells.size() <= kHubCells) {
    const auto first = cells.begin() + (isGhost(c) ? 0 : stars_[v].ghosts);
    return static_cast<std::uint32_t>(std::find(first, cells.end(), c) - cells.begin());
  }
  const auto [hub, isNew] = placesInHub_.try_emplace(v);
  auto& places = hub->second;
  for (std::uint32_t i = 0; isNew && i < cells.size(); ++i) places[cells[i]] = i;
  return places.extract(c).mapped();
}

void FusionMesh::moveInStar(VertexId v, std::uint32_t from, std::uint32_t to) {
  if (from == to) return;
  CellId* cells = &pool_[stars_[v].first];
  cells[to] = cells[from];
  if (stars_[v].size < kHubCells) return;
  if (const auto hub = placesInHub_.find(v); hub != placesInHub_.end()) hub->second[cells[to]] = to;
}

void FusionMesh::findPlane(CellId ghost) {
  const auto& cell = history_.cells[ghost];
  const Vector3 a = position(cell[0]), normal = cross(position(cell[1]) - a, position(cell[2]) - a);
  const double squared = dot(normal, normal);
  planes_[ghost - firstGhost_] = {normal, squared > 0 ? 1 / std::sqrt(squared) : 0};
}

// The boundary triangles that stay get the bound of the whole star.
void FusionMesh::pushOutside(const Star& star, float outside) {
  if (outside_.empty()) outside_.assign(history_.cells.size() - firstGhost_, 0);
  for (const CellId c : star.affected)
    if (c >= firstGhost_) outside_[c - firstGhost_] = outside;
}

VertexId FusionMesh::fuse(const Prey& prey, const FusedVertex& what, const Star& star, std::uint32_t level) {
  for (const VertexId v : star.link)
    if (v != kGhost) prefetchList(v);
  record(prey, placed(prey, what.point), star, level);
  if (what.outside > 0) pushOutside(star, what.outside);
  const VertexId fused = history_.fusions.back().fused;
  history_.points.push_back(what.point);
  std::size_t first = 0;
  for (std::size_t f = 0; f < history_.fields.size(); ++f) {
    if (isCellField(history_.fields[f])) continue;
    const auto own = what.values.subspan(first, history_.fields[f].components);
    history_.values[f].insert(history_.values[f].end(), own.begin(), own.end());
    first += own.size();
  }
  bool boundary = false, interface = false;
  for (const VertexId v : prey.vertices()) {
    boundary |= onBoundary_[v] != 0;
    interface |= hasRegions() && onInterface_[v];
    aliveVertex_[v] = 0;
    livePool_ -= stars_[v].size;
    stars_[v].size = stars_[v].ghosts = 0;
  }
  for (std::size_t i = 0; i < star.affected.size(); ++i) {
    const CellId c = star.affected[i];
    auto& cell = history_.cells[c];
    cell[onlyCorner(cornersThatAre(cell, prey.vertex[star.labels[i]]))] = fused;
    if (isGhost(c)) findPlane(c);
  }
  for (const CellId c : star.deleted) {
    history_.live[c] = 0;
    liveTetrahedra_ -= !isGhost(c);
    const auto& cell = history_.cells[c];
    unsigned gone = 0;
    for (const VertexId v : prey.vertices()) gone |= cornersThatAre(cell, v);
    const OtherCorners& others = kOtherCorners[gone];
    for (std::size_t i = 0; i < others.count; ++i)
      if (const VertexId v = cell[others.corner[i]]; v != kGhost) removeFromStar(v, c);
  }
  onBoundary_.push_back(boundary);
  if (hasRegions()) onInterface_.push_back(interface);
  singular_.push_back(0);
  aliveVertex_.push_back(1);
  addStar(star.affected);
  if (pool_.size() > 2 * livePool_ + 4096) compactPool();
  return fused;
}

// The fused vertex's, ghosts first.
void FusionMesh::addStar(std::span<const CellId> cells) {
  const std::size_t first = pool_.size();
  pool_.resize(first + cells.size());
  std::size_t ghosts = 0, at = cells.size();
  for (const CellId c : cells) pool_[first + (isGhost(c) ? ghosts++ : --at)] = c;
  stars_.push_back({first, static_cast<std::uint32_t>(cells.size()), static_cast<std::uint32_t>(ghosts)});
  livePool_ += cells.size();
}

void FusionMesh::compactPool() {
  std::vector<CellId> pool;
  pool.reserve(livePool_ + livePool_ / 4);
  for (StarRange& s : stars_) {
    const std::uint64_t first = pool.size();
    for (std::uint32_t i = 0; i < s.size; ++i) pool.push_back(pool_[s.first + i]);
    s.first = first;
  }
  pool_ = std::move(pool);
}

FusionHistory FusionMesh::takeHistory(std::uint32_t levels) {
  history_.levels = levels;
  return std::move(history_);
}

}  // namespace qtet
