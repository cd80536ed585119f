// Codes which half of a node each of its cells belongs to (FORMAT.md, "Child bits"). Each cell
// costs one adaptive bit. It is predicted from the cell's side of a plane that the encoder chose,
// and from the cells round its vertices that were coded before.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "codec/coding/range_coder.h"
#include "codec/mesh/node_cells.h"

namespace qtet {

struct ChildModels {
  static constexpr std::size_t kSides = 13, kVotes = 10;
  // tetrahedron or boundary triangle, distance to the plane, votes
  std::array<std::array<std::array<BitModel, kVotes>, kSides>, 2> bit;
};

template <class Coder>
class ChildCoder {
 public:
  /// `counts` is scratch.
  ChildCoder(Coder& coder, ChildModels& models, const GrowingMesh& mesh, int positionBits,
             VertexCounts& counts)
      : coder_(coder), models_(models), mesh_(mesh), positionBits_(positionBits), counts_(counts) {}

  /// Codes one bit for each of the node's cells and deals them out to its children. An encoder's
  /// `truth(ref)` is 0 or 1. False: not valid (decoder).
  template <class Truth>
  [[nodiscard]] bool code(const NodeCells& node, const Truth& truth,
                          std::array<NodeCells, 2>& children) {
    children = {};
    if (node.empty()) return true;
    if constexpr (Coder::kEncoding) choosePlane(node, truth);
    axis_ = coder_.raw(static_cast<std::uint32_t>(axis_), 2);
    if (axis_ > 2) return false;
    plane_ =
        static_cast<std::int32_t>(coder_.raw(static_cast<std::uint32_t>(plane_), positionBits_));
    counts_.makeRoom(mesh_.points.size());
    node.forEach([&](CellRef ref) {
      const auto bit =
          static_cast<std::size_t>(coder_.bit(Coder::kEncoding ? truth(ref) : 0, model(ref)));
      for (const VertexId v : mesh_.cell(ref))
        if (v != kGhost) counts_.add(v, bit);
      if (ref & kBoundaryBit)
        children[bit].triangles.push_back(ref & ~kBoundaryBit);
      else
        children[bit].tetrahedra.push_back(ref);
    });
    counts_.clear();
    return true;
  }

 private:
  /// A cell along one axis.
  struct Extent {
    std::int64_t sum = 0;  // of its corners
    std::int64_t corners = 0;
    std::int32_t least = 0, most = 0;
  };
  [[nodiscard]] Extent extent(CellRef ref, std::size_t axis) const {
    Extent e;
    for (const VertexId v : mesh_.cell(ref)) {
      if (v == kGhost) continue;
      const std::int32_t x = mesh_.points[v][axis];
      e.least = e.corners == 0 ? x : std::min(e.least, x);
      e.most = e.corners == 0 ? x : std::max(e.most, x);
      e.sum += x;
      ++e.corners;
    }
    return e;
  }

  // The distance counts in quarters of the cell's own length.
  BitModel& model(CellRef ref) {
    const Extent e = extent(ref, axis_);
    const std::int64_t distance =
        4 * (e.sum - e.corners * plane_) / (e.corners * (std::int64_t{e.most} - e.least + 1));
    const auto side = static_cast<std::size_t>(std::clamp<std::int64_t>(distance, -6, 6) + 6);
    std::uint64_t ones = 0, all = 0;
    for (const VertexId v : mesh_.cell(ref))
      if (v != kGhost) ones += counts_.of(v)[1], all += counts_.of(v)[0] + counts_.of(v)[1];
    const std::size_t votes = all == 0 ? 9 : static_cast<std::size_t>(ones * 8 / all);
    return models_.bit[(ref & kBoundaryBit) != 0][side][votes];
  }

  // The plane with the fewest cells on the wrong side; any would do.
  template <class Truth>
  void choosePlane(const NodeCells& node, const Truth& truth) {
    std::int64_t fewest = -1;
    std::vector<std::pair<std::int32_t, int>> cells;
    for (std::uint32_t axis = 0; axis < 3; ++axis) {
      cells.clear();
      std::int64_t wrong = 0;  // with all cells above the plane
      node.forEach([&](CellRef ref) {
        const Extent e = extent(ref, axis);
        cells.emplace_back(static_cast<std::int32_t>(e.sum / e.corners), truth(ref));
        wrong += cells.back().second == 0;
      });
      std::sort(cells.begin(), cells.end());
      for (std::size_t i = 0; i < cells.size(); ++i) {
        if ((i == 0 || cells[i].first != cells[i - 1].first) && (fewest < 0 || wrong < fewest))
          fewest = wrong, axis_ = axis, plane_ = cells[i].first;
        wrong += cells[i].second == 0 ? -1 : 1;
      }
    }
  }

  Coder& coder_;
  ChildModels& models_;
  const GrowingMesh& mesh_;
  int positionBits_;
  VertexCounts& counts_;
  std::uint32_t axis_ = 0;
  std::int32_t plane_ = 0;
};

}  // namespace qtet
