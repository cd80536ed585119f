#include <cmath>

#include "codec/coding/float_rounding.h"
#include "simplify/samples/samples.h"

namespace qtet {
namespace {

constexpr VertexId kCells = 8;

VertexId vertexAt(VertexId i, VertexId j, VertexId k) {
  return (k * (kCells + 1) + j) * (kCells + 1) + i;
}

/// cos(n pi / 8) for any n, by square roots.
double cosineOfEighths(VertexId n) {
  const double r = std::sqrt(0.5);
  const std::array<double, 5> quarter{1, std::sqrt((1 + r) / 2), r, std::sqrt((1 - r) / 2), 0};
  n %= 16;
  if (n > 8) n = 16 - n;
  return n <= 4 ? quarter[n] : -quarter[8 - n];
}

/// The field at lattice point (i, j, k): sin(2 pi i / 8) = cos((2 i + 12) pi / 8).
double scalarAt(VertexId i, VertexId j, VertexId k) {
  const double z = static_cast<double>(k) / kCells;
  return roundedToFloat(cosineOfEighths(2 * i + 12) * cosineOfEighths(j) + z * z);
}

/// Kuhn's six tetrahedra: one for each order in which a path walks the three axes from a cube's
/// lowest to its highest corner.
void addCube(VertexId i, VertexId j, VertexId k, std::vector<Tetrahedron>& out) {
  constexpr std::array<std::array<std::size_t, 3>, 6> kOrders{
      {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}}};
  for (std::size_t path = 0; path < kOrders.size(); ++path) {
    std::array<VertexId, 3> at{i, j, k};
    Tetrahedron cell{vertexAt(i, j, k)};
    for (std::size_t step = 0; step < 3; ++step) {
      ++at[kOrders[path][step]];
      cell[step + 1] = vertexAt(at[0], at[1], at[2]);
    }
    if (path >= 3) std::swap(cell[2], cell[3]);  // the odd permutations
    out.push_back(cell);
  }
}

}  // namespace

TetMesh boxSample() {
  TetMesh mesh;
  MeshField scalar{"Scalar", 1, "float32", {}};
  for (VertexId k = 0; k <= kCells; ++k) {
    for (VertexId j = 0; j <= kCells; ++j) {
      for (VertexId i = 0; i <= kCells; ++i) {
        mesh.points.push_back({static_cast<double>(i) / kCells, static_cast<double>(j) / kCells,
                               static_cast<double>(k) / kCells});
        scalar.values.push_back(scalarAt(i, j, k));
      }
    }
  }
  for (VertexId k = 0; k < kCells; ++k) {
    for (VertexId j = 0; j < kCells; ++j) {
      for (VertexId i = 0; i < kCells; ++i) addCube(i, j, k, mesh.tetrahedra);
    }
  }
  mesh.fields.push_back(std::move(scalar));
  return mesh;
}

}  // namespace qtet
