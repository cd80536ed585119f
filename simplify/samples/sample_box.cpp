#include <array>
#include <cmath>

#include "codec/coding/float_rounding.h"
#include "simplify/samples/cube_grid.h"
#include "simplify/samples/samples.h"

namespace qtet {
namespace {

constexpr VertexId kCells = 8;

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

}  // namespace

TetMesh boxSample() {
  constexpr CubeGrid kGrid{{kCells, kCells, kCells}};
  TetMesh mesh;
  MeshField scalar{"Scalar", 1, "float32", {}};
  kGrid.forEachPoint([&](const std::array<VertexId, 3>& at) {
    const auto [i, j, k] = at;
    mesh.points.push_back({static_cast<double>(i) / kCells, static_cast<double>(j) / kCells,
                           static_cast<double>(k) / kCells});
    scalar.values.push_back(scalarAt(i, j, k));
  });
  mesh.tetrahedra = kGrid.cells();
  mesh.fields.push_back(std::move(scalar));
  return mesh;
}

}  // namespace qtet
