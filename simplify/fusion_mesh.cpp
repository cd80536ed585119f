#include "simplify/fusion_mesh.h"

#include <algorithm>
#include <cmath>

#include "codec/boundary.h"
#include "codec/face_groups.h"
#include "codec/growing_mesh.h"
#include "codec/link.h"

namespace qtet {
namespace {

// A boundary plane counts this much more than an interior one: the paper's "weighted planar quadric error metrics" that keep features.
constexpr double kBoundaryFactor = 10;

}  // namespace

FusionMesh::FusionMesh(const LatticeMesh& mesh) : liveTetrahedra_(mesh.tetrahedra.size()) {
  history_.lattice = mesh.lattice;
  history_.fields = mesh.fields;
  history_.points = mesh.points;
  history_.values = mesh.values;
  history_.cells.assign(mesh.tetrahedra.begin(), mesh.tetrahedra.end());
  onBoundary_.assign(mesh.points.size(), 0);
  for (const Triangle& t : mesh.boundary) {
    history_.cells.push_back({t[0], t[1], t[2], kGhost});
    for (const VertexId v : t) onBoundary_[v] = 1;
  }
  history_.live.assign(history_.cells.size(), 1);
  aliveVertex_.assign(mesh.points.size(), 1);
  buildStars();
  findSingular();
  buildQuadrics(mesh.tetrahedra.size());
}

void FusionMesh::buildStars() {
  stars_.assign(history_.points.size(), {});
  for (const auto& c : history_.cells)
    for (const VertexId v : c)
      if (v != kGhost) ++stars_[v].size;
  for (Star& s : stars_) {
    s.first = livePool_;
    livePool_ += s.size;
    s.size = 0;
  }
  pool_.resize(livePool_);
  for (CellId c = 0; c < history_.cells.size(); ++c)
    for (const VertexId v : history_.cells[c])
      if (v != kGhost) pool_[stars_[v].first + stars_[v].size++] = c;
}

void FusionMesh::findSingular() {
  singular_.assign(history_.points.size(), 0);
  Link link;
  for (VertexId v = 0; v < history_.points.size(); ++v) {
    link.clear(history_.points.size());
    for (const CellId c : star(v)) {
      const auto turned = withLast(cell(c), static_cast<std::size_t>(std::ranges::find(cell(c), v) - cell(c).begin()));
      link.add(turned[0], turned[1], turned[2]);
    }
    singular_[v] = !link.close() || !link.isSphere();
  }
}

void FusionMesh::buildQuadrics(std::size_t tetrahedra) {
  quadrics_.assign(history_.points.size(), {});
  std::vector<Tetrahedron> cells(history_.cells.begin(), history_.cells.begin() + static_cast<std::ptrdiff_t>(tetrahedra));
  FaceGroups(cells).forEach([&](std::span<const FaceSide> sides) {
    const Triangle face = cellFace(cells[cellOf(sides[0])], oppositeCornerOf(sides[0]));
    Quadric q;
    q.addTriangle(position(face[0]), position(face[1]), position(face[2]), sides.size() == 1 ? kBoundaryFactor : 1);
    for (const VertexId v : face) quadrics_[v] += q;
  });
}

void FusionMesh::blendValues(const Prey& prey, const FusionPoint& where) {
  std::array<double, 4> weight{};
  double total = 0;
  for (std::size_t i = 0; i < prey.k; ++i) {
    const Vector3 p{static_cast<double>(where.point[0]), static_cast<double>(where.point[1]), static_cast<double>(where.point[2])};
    const Vector3 d = position(prey.vertex[i]) - p;
    weight[i] = where.stays == FusionPoint::kMoves ? 1 / (dot(d, d) + 1) : static_cast<int>(i) == where.stays;
    total += weight[i];
  }
  for (std::size_t f = 0; f < history_.fields.size(); ++f) {
    if (isCellField(history_.fields[f])) continue;  // cells keep their values for life
    const std::size_t n = history_.fields[f].components;
    std::vector<std::int32_t>& values = history_.values[f];
    for (std::size_t c = 0; c < n; ++c) {
      double sum = 0;
      for (std::size_t i = 0; i < prey.k; ++i) sum += weight[i] * values[prey.vertex[i] * n + c];
      values.push_back(static_cast<std::int32_t>(std::floor(sum / total + 0.5)));
    }
  }
}

VertexId FusionMesh::fuse(const Prey& prey, const FusionPoint& where, std::span<const CellId> affected, std::span<const std::uint8_t> labels,
                          std::span<const CellId> deleted, std::span<const VertexId> link, std::uint32_t level) {
  const auto fused = static_cast<VertexId>(history_.points.size());
  blendValues(prey, where);
  history_.points.push_back(where.point);

  Fusion record;
  record.k = prey.k;
  record.moved = where.stays == FusionPoint::kMoves;
  record.level = level;
  record.fused = fused;
  record.prey = prey.vertex;
  const auto first = record.moved ? 0u : static_cast<std::uint8_t>(where.stays);
  std::swap(record.prey[0], record.prey[first]);
  record.firstAffected = history_.affectedCells.size();
  record.affectedCount = static_cast<std::uint32_t>(affected.size());
  record.firstDeleted = history_.deletedCells.size();
  record.deletedCount = static_cast<std::uint32_t>(deleted.size());
  history_.fusions.push_back(record);
  history_.affectedCells.insert(history_.affectedCells.end(), affected.begin(), affected.end());
  for (const std::uint8_t label : labels) history_.affectedLabels.push_back(label == first ? 0 : label == 0 ? static_cast<std::uint8_t>(first) : label);
  history_.deletedCells.insert(history_.deletedCells.end(), deleted.begin(), deleted.end());

  for (std::size_t i = 0; i < affected.size(); ++i) std::ranges::replace(history_.cells[affected[i]], prey.vertex[labels[i]], fused);
  for (const CellId c : deleted) {
    history_.live[c] = 0;
    if (std::ranges::find(history_.cells[c], kGhost) == history_.cells[c].end()) --liveTetrahedra_;
  }
  Quadric q;
  bool boundary = false;
  for (const VertexId v : prey.vertices()) {
    q += quadrics_[v];
    boundary |= onBoundary_[v] != 0;
    aliveVertex_[v] = 0;
    livePool_ -= stars_[v].size;
    stars_[v].size = 0;
  }
  for (const VertexId v : link) {
    if (v == kGhost) continue;
    const auto cells = std::span(pool_).subspan(stars_[v].first, stars_[v].size);
    const auto kept = std::ranges::remove_if(cells, [&](CellId c) { return !history_.live[c]; });
    stars_[v].size -= static_cast<std::uint32_t>(kept.size());
    livePool_ -= kept.size();
  }
  quadrics_.push_back(q);
  onBoundary_.push_back(boundary);
  singular_.push_back(0);
  aliveVertex_.push_back(1);
  stars_.push_back({pool_.size(), static_cast<std::uint32_t>(affected.size())});
  pool_.insert(pool_.end(), affected.begin(), affected.end());
  livePool_ += affected.size();
  if (pool_.size() > 4 * livePool_ + 4096) compactPool();
  return fused;
}

void FusionMesh::compactPool() {
  std::vector<CellId> pool;
  pool.reserve(2 * livePool_);
  for (Star& s : stars_) {
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
