#include "simplify/measure/measured_mesh.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numeric>

#include "codec/mesh/predicates.h"

namespace qtet {
namespace {

double diagonalOf(const std::vector<LatticePoint>& points,
                  std::span<const TriangleTree::Cell> triangles) {
  LatticePoint low, high;
  low.fill(std::numeric_limits<std::int32_t>::max());
  high.fill(std::numeric_limits<std::int32_t>::min());
  for (const TriangleTree::Cell& t : triangles)
    for (std::size_t corner = 0; corner < 3; ++corner)
      for (std::size_t k = 0; k < 3; ++k) {
        low[k] = std::min(low[k], points[t[corner]][k]);
        high[k] = std::max(high[k], points[t[corner]][k]);
      }
  const Vector3 size = toVector(high) - toVector(low);
  return std::sqrt(dot(size, size));
}

}  // namespace

MeasuredMesh::MeasuredMesh(HistoryLevels& levels, const OriginalSamples* before) : levels_(levels) {
  levels.moveTo(levels.finest());
  lastFusion_.assign(history().cells.size(), 0);
  for (std::uint32_t i = 0; i < history().cells.size(); ++i)
    if (history().live[i] && isGhost(i))
      originalBoundary_.push_back(i), originalTriangles_.push_back(history().cells[i]);
  boundary_ = originalBoundary_;
  std::vector<std::uint32_t> all(originalBoundary_.size());
  std::iota(all.begin(), all.end(), 0u);
  originalTree_.emplace(history().points, originalTriangles_, std::move(all));
  rebuildTree();
  originalVolume_ = before ? before->volume6 : volume();
  diagonal_ = before ? before->diagonal : diagonalOf(history().points, originalTriangles_);
}

void MeasuredMesh::coarsen() {
  assert(level() > 0);
  levels_.coarsen();
  step_ = levels_.fusionsInto(levels_.level());
  for (const Fusion& fusion : step_) {
    assert(fusion.level < history().levels);
    const auto mark = static_cast<std::uint32_t>(&fusion - history().fusions.data()) + 1;
    for (const std::uint32_t cell : affected(fusion)) lastFusion_[cell] = mark;
    for (const std::uint32_t cell :
         std::span(history().deletedCells).subspan(fusion.firstDeleted, fusion.deletedCount))
      lastFusion_[cell] = mark;
  }
}

void MeasuredMesh::fitTree() {
  std::erase_if(boundary_, [&](std::uint32_t ghost) { return !history().live[ghost]; });
  if (boundary_.size() * 2 < tree_->builtOver()) {
    rebuildTree();
  } else {
    tree_->refit(history().live);
  }
}

void MeasuredMesh::rebuildTree() { tree_.emplace(history().points, history().cells, boundary_); }

const Fusion* MeasuredMesh::fusionOf(std::uint32_t cell) const {
  assert(cell < lastFusion_.size());
  if (lastFusion_[cell] == 0) return nullptr;
  const Fusion* fusion = &history().fusions[lastFusion_[cell] - 1];
  return fusion >= step_.data() && fusion < step_.data() + step_.size() ? fusion : nullptr;
}

std::uint32_t MeasuredMesh::originalTriangle(std::uint32_t ghost) const {
  assert(!originalBoundary_.empty() && ghost >= originalBoundary_.front());
  // boundary cells stand behind all others, fusion_history.h
  assert(isGhost(ghost) && ghost - originalBoundary_.front() < originalTriangles_.size());
  return ghost - originalBoundary_.front();
}

double MeasuredMesh::volume() const {
  Int128 sum = 0;  // exact: at most 2^29 triangles of 2^87
  for (const std::uint32_t ghost : boundary_) {
    assert(isGhost(ghost) && history().live[ghost]);
    const auto& cell = history().cells[ghost];
    const std::vector<LatticePoint>& points = history().points;
    sum += volume6({0, 0, 0}, points[cell[0]], points[cell[1]], points[cell[2]]);
  }
  return static_cast<double>(sum);
}

double MeasuredMesh::volumeKept() const {
  return originalVolume_ > 0 ? volume() / originalVolume_ : 1;
}

}  // namespace qtet
