#include "simplify/samples/cube_grid.h"

#include <utility>

namespace qtet {
namespace {

/// One tetrahedron for each order in which a path walks the three axes from a cube's lowest to its
/// highest corner.
void addCube(const CubeGrid& grid, const std::array<VertexId, 3>& corner,
             std::vector<Tetrahedron>& out) {
  constexpr std::array<std::array<std::size_t, 3>, 6> kOrders{
      {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}}};
  for (std::size_t path = 0; path < kOrders.size(); ++path) {
    std::array<VertexId, 3> at = corner;
    Tetrahedron cell{grid.pointAt(at)};
    for (std::size_t step = 0; step < 3; ++step) {
      ++at[kOrders[path][step]];
      cell[step + 1] = grid.pointAt(at);
    }
    if (path >= 3) std::swap(cell[2], cell[3]);  // the odd permutations
    out.push_back(cell);
  }
}

}  // namespace

std::vector<Tetrahedron> CubeGrid::cells() const {
  std::vector<Tetrahedron> out;
  out.reserve(tetrahedra());
  const CubeGrid corners{{cubes[0] - 1, cubes[1] - 1, cubes[2] - 1}};
  corners.forEachPoint([&](const auto& corner) { addCube(*this, corner, out); });
  return out;
}

}  // namespace qtet
