#include "tests/support/block_grid.h"

#include <cmath>
#include <numbers>

namespace qtet::testing {
namespace {

// Corner 4 i + 2 j + k of the cube; the middle cell first. In an odd cube i is mirrored.
constexpr std::array<std::array<int, 4>, 5> kFive{
    {{0, 3, 5, 6}, {1, 0, 3, 5}, {2, 3, 0, 6}, {4, 0, 5, 6}, {7, 5, 3, 6}}};

double volume6(const TetMesh& mesh, const Tetrahedron& t) {
  const Position& a = mesh.points[t[0]];
  std::array<Position, 3> edge{};
  for (std::size_t e = 0; e < 3; ++e)
    for (std::size_t axis = 0; axis < 3; ++axis)
      edge[e][axis] = mesh.points[t[e + 1]][axis] - a[axis];
  const auto& [u, v, w] = edge;
  return (u[1] * v[2] - u[2] * v[1]) * w[0] + (u[2] * v[0] - u[0] * v[2]) * w[1] +
         (u[0] * v[1] - u[1] * v[0]) * w[2];
}

}  // namespace

TetMesh blockGrid(std::array<int, 3> cells, const std::function<Position(int, int, int)>& place) {
  TetMesh mesh;
  MeshField distance{"Distance", 1, "float32", {}, "point"};
  for (int i = 0; i <= cells[0]; ++i)
    for (int j = 0; j <= cells[1]; ++j)
      for (int k = 0; k <= cells[2]; ++k) {
        const Position p = place(i, j, k);
        mesh.points.push_back(p);
        distance.values.push_back(
            static_cast<double>(static_cast<float>(std::hypot(p[0], p[1], p[2]))));
      }
  mesh.fields.push_back(distance);
  const auto point = [&](int i, int j, int k) {
    return static_cast<VertexId>((i * (cells[1] + 1) + j) * (cells[2] + 1) + k);
  };
  for (int i = 0; i < cells[0]; ++i)
    for (int j = 0; j < cells[1]; ++j)
      for (int k = 0; k < cells[2]; ++k)
        for (const auto& corners : kFive) {
          Tetrahedron cell{};
          for (std::size_t c = 0; c < 4; ++c) {
            const int corner = (i + j + k) % 2 == 0 ? corners[c] : corners[c] ^ 4;
            cell[c] = point(i + (corner >> 2), j + (corner >> 1 & 1), k + (corner & 1));
          }
          if (volume6(mesh, cell) < 0) std::swap(cell[2], cell[3]);
          mesh.tetrahedra.push_back(cell);
        }
  return mesh;
}

TetMesh slitRing(int round, int across) {
  return blockGrid({round, across, across}, [=](int i, int j, int k) {
    const double angle = 2 * std::numbers::pi * (i % round) / round, radius = 2 + 1.0 * j / across;
    return Position{static_cast<float>(radius * std::cos(angle)),
                    static_cast<float>(radius * std::sin(angle)),
                    static_cast<float>(1.0 * k / across)};
  });
}

}  // namespace qtet::testing
