// A mesh whose fields are series, for tests: some instants are smooth in time, some are equal.
#pragma once

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "simplify/series/series.h"
#include "tests/support/meshes.h"

namespace qtet::testing {

/// gridMesh(n, seed) with two series in the order of decoding. The point series "T" has so many
/// instants at times 0, 0.5, 1, ..., the cell series "C" three equal ones.
inline LatticeMesh seriesMesh(int n, std::uint32_t seed, std::size_t instants) {
  LatticeMesh mesh = gridMesh(n, seed);
  mesh.fields.clear(), mesh.values.clear();
  for (const InstantStep& step : decodingOrder(instants)) {
    const double time = 0.5 * static_cast<double>(step.instant);
    std::string text = std::to_string(time);
    text.erase(text.find_last_not_of('0') + 1);
    if (text.back() == '.') text.pop_back();
    mesh.fields.push_back({"T@" + text, 1, "float32", "point", 12, 0.25, {-3}, {-3, 1020}});
    std::vector<std::int32_t>& values = mesh.values.emplace_back();
    for (const LatticePoint& p : mesh.points)
      values.push_back(2000 + static_cast<std::int32_t>(
                                  1500 * std::sin(0.002 * p[0] + 0.001 * p[2] - 0.3 * time)));
  }
  for (const std::size_t instant : {0u, 2u, 1u}) {
    mesh.fields.push_back(
        {"C@" + std::to_string(instant), 2, "float32", "cell", 12, 0.5, {-1, 2}, {0, 900}});
    std::vector<std::int32_t>& values = mesh.values.emplace_back();
    for (const Tetrahedron& t : mesh.tetrahedra)
      values.push_back(mesh.points[t[0]][0] % 4096), values.push_back(mesh.points[t[1]][2] % 4096);
  }
  return mesh;
}

}  // namespace qtet::testing
