#include "simplify/parts/cut_mesh.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <utility>

namespace qtet {
namespace {

/// The live tetrahedra in blocks, cut by planes across the longest side of what is cut.
class Blocks {
 public:
  Blocks(const FusionMesh& mesh, std::size_t count) {
    std::vector<Cell> cells;
    cells.reserve(mesh.liveTetrahedra());
    for (CellId c = 0; c < mesh.firstGhost(); ++c) {
      if (!mesh.isLive(c)) continue;
      Cell& cell = cells.emplace_back(Cell{{}, c});
      for (const VertexId v : mesh.cell(c))
        for (std::size_t axis = 0; axis < 3; ++axis) cell.middle[axis] += mesh.point(v)[axis];
    }
    assert(cells.size() == mesh.liveTetrahedra());
    cut(cells, count);
  }

  [[nodiscard]] std::vector<std::vector<CellId>> take() { return std::move(blocks_); }

 private:
  struct Cell {
    std::array<std::uint32_t, 3> middle;  // four times its coordinates
    CellId cell;
  };

  static std::size_t longestAxis(std::span<const Cell> cells) {
    assert(!cells.empty());
    std::array<std::uint32_t, 3> low = cells.front().middle, high = low, length{};
    for (const Cell& cell : cells)
      for (std::size_t axis = 0; axis < 3; ++axis) {
        low[axis] = std::min(low[axis], cell.middle[axis]);
        high[axis] = std::max(high[axis], cell.middle[axis]);
      }
    for (std::size_t axis = 0; axis < 3; ++axis) length[axis] = high[axis] - low[axis];
    return static_cast<std::size_t>(std::ranges::max_element(length) - length.begin());
  }

  void cut(std::span<Cell> cells, std::size_t count) {
    if (count <= 1 || cells.size() <= 1) {
      std::vector<CellId>& block = blocks_.emplace_back();
      for (const Cell& cell : cells) block.push_back(cell.cell);
      std::ranges::sort(block);
      return;
    }
    const std::size_t axis = longestAxis(cells), first = count / 2;
    const std::size_t at = cells.size() * first / count;
    std::ranges::nth_element(cells, cells.begin() + static_cast<std::ptrdiff_t>(at),
                             [axis](const Cell& a, const Cell& b) {
                               return a.middle[axis] != b.middle[axis]
                                          ? a.middle[axis] < b.middle[axis]
                                          : a.cell < b.cell;
                             });
    cut(cells.first(at), first);
    cut(cells.subspan(at), count - first);
  }

  std::vector<std::vector<CellId>> blocks_;
};

void takeParts(std::span<const CellId> block, std::span<const std::uint32_t> partOf,
               std::uint32_t count, CutMesh& out) {
  std::vector<std::vector<CellId>> parts(count);
  assert(partOf.size() == block.size());
  for (std::size_t i = 0; i < block.size(); ++i) {
    assert(partOf[i] < count);
    parts[partOf[i]].push_back(block[i]);
  }
  for (std::vector<CellId>& part : parts)
    if (!part.empty()) out.parts.push_back(std::move(part));
}

/// The vertices of several parts, and their share.
void findSeams(const FusionMesh& mesh, CutMesh& out) {
  constexpr std::uint32_t kNobody = ~std::uint32_t{0};
  out.isSeam.assign(mesh.vertexSlots(), 0);
  std::vector<std::uint32_t> owner(mesh.vertexSlots(), kNobody);
  for (std::uint32_t p = 0; p < out.parts.size(); ++p)
    for (const CellId c : out.parts[p])
      for (const VertexId v : mesh.cell(c)) {
        if (owner[v] == kNobody) owner[v] = p;
        out.isSeam[v] |= owner[v] != p;
      }
  const auto used = owner.size() - static_cast<std::size_t>(std::ranges::count(owner, kNobody));
  const auto seams = static_cast<std::size_t>(std::ranges::count(out.isSeam, 1));
  assert(seams <= used);
  if (used > 0) out.innerShare = static_cast<double>(used - seams) / static_cast<double>(used);
}

}  // namespace

CutMesh cutMesh(const FusionMesh& mesh, const Partitioner& partition, std::size_t cellsOfAPart,
                std::uint32_t band, std::span<const std::uint8_t> old, Workers& workers,
                std::size_t blockCells) {
  assert(cellsOfAPart > 0 && blockCells > 0);
  const std::size_t cells = mesh.liveTetrahedra();
  std::size_t count = (cells + blockCells - 1) / blockCells;
  if (count > 1) count += band % 2;
  const std::vector<std::vector<CellId>> blocks = Blocks(mesh, count).take();
  const auto wanted = [&](std::size_t b) {
    return (blocks[b].size() + cellsOfAPart / 2) / cellsOfAPart;
  };
  CutMesh out;
  // The partitioner takes one block after the other: METIS shares its random numbers, and the
  // handlers of signals, among all threads.
  for (std::size_t first = 0; first < blocks.size(); first += workers.count()) {
    const std::size_t together = std::min(workers.count(), blocks.size() - first);
    std::vector<CellGraph> graphs(together);
    workers.forEach(together, 1, [&](std::size_t, std::size_t i) {
      if (wanted(first + i) > 1) graphs[i] = cellGraphOf(mesh, blocks[first + i], old);
    });
    for (std::size_t i = 0; i < together; ++i) {
      const std::vector<CellId>& block = blocks[first + i];
      const auto parts = static_cast<std::uint32_t>(std::max<std::size_t>(wanted(first + i), 1));
      std::vector<std::uint32_t> partOf(block.size(), 0);
      if (parts > 1) partOf = partition(graphs[i], parts);
      graphs[i] = {};
      takeParts(block, partOf, parts, out);
    }
  }
  findSeams(mesh, out);
  return out;
}

}  // namespace qtet
