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
  Blocks(const FusionMesh& mesh, std::size_t count) : mesh_(mesh) {
    std::vector<CellId> cells;
    cells.reserve(mesh.liveTetrahedra());
    for (CellId c = 0; c < mesh.firstGhost(); ++c)
      if (mesh.isLive(c)) cells.push_back(c);
    cut(std::move(cells), count);
  }

  [[nodiscard]] std::vector<std::vector<CellId>> take() { return std::move(blocks_); }

 private:
  /// Four times the middle of a cell along an axis.
  [[nodiscard]] std::uint64_t middle(CellId c, std::size_t axis) const {
    std::uint64_t sum = 0;
    for (const VertexId v : mesh_.cell(c)) sum += mesh_.point(v)[axis];
    return sum;
  }

  [[nodiscard]] std::size_t longestAxis(std::span<const CellId> cells) const {
    std::array<std::uint64_t, 3> length{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto [least, most] =
          std::ranges::minmax(cells, {}, [&](CellId c) { return middle(c, axis); });
      length[axis] = middle(most, axis) - middle(least, axis);
    }
    return static_cast<std::size_t>(std::ranges::max_element(length) - length.begin());
  }

  void cut(std::vector<CellId> cells, std::size_t count) {
    if (count <= 1 || cells.size() <= 1) {
      std::ranges::sort(cells);
      blocks_.push_back(std::move(cells));
      return;
    }
    const std::size_t axis = longestAxis(cells), first = count / 2;
    const auto key = [&](CellId c) { return std::pair(middle(c, axis), c); };
    const auto at = cells.begin() + static_cast<std::ptrdiff_t>(cells.size() * first / count);
    std::ranges::nth_element(cells, at, {}, key);
    std::vector<CellId> rest(at, cells.end());
    cells.erase(at, cells.end());
    cut(std::move(cells), first);
    cut(std::move(rest), count - first);
  }

  const FusionMesh& mesh_;
  std::vector<std::vector<CellId>> blocks_;
};

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
  if (used > 0) out.innerShare = static_cast<double>(used - seams) / static_cast<double>(used);
}

}  // namespace

CutMesh cutMesh(const FusionMesh& mesh, const Partitioner& partition, std::size_t cellsOfAPart,
                std::uint32_t band, std::span<const std::uint8_t> old, Workers& workers,
                std::size_t blockCells) {
  const std::size_t cells = mesh.liveTetrahedra();
  std::size_t count = (cells + blockCells - 1) / blockCells;
  if (count > 1) count += band % 2;
  const std::vector<std::vector<CellId>> blocks = Blocks(mesh, count).take();
  std::vector<std::vector<std::vector<CellId>>> parts(blocks.size());
  workers.forEach(blocks.size(), 1, [&](std::size_t, std::size_t b) {
    const std::vector<CellId>& block = blocks[b];
    const std::size_t wanted = (block.size() + cellsOfAPart / 2) / cellsOfAPart;
    parts[b].resize(std::max<std::size_t>(wanted, 1));
    if (wanted < 2) {
      parts[b][0] = block;
      return;
    }
    const std::vector<std::uint32_t> partOf =
        partition(cellGraphOf(mesh, block, old), static_cast<std::uint32_t>(wanted));
    assert(partOf.size() == block.size());
    for (std::size_t i = 0; i < block.size(); ++i) parts[b][partOf[i]].push_back(block[i]);
  });
  CutMesh out;
  for (std::vector<std::vector<CellId>>& ofBlock : parts)
    for (std::vector<CellId>& part : ofBlock)
      if (!part.empty()) out.parts.push_back(std::move(part));
  findSeams(mesh, out);
  return out;
}

}  // namespace qtet
