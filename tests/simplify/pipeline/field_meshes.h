// Meshes with fields of both associations, for the pipeline and for those who call it.
#pragma once

#include <cmath>

#include "simplify/samples/samples.h"

namespace qtet::testing {

/// The sample box with a vector on its points, and on its cells a label and a value.
[[nodiscard]] inline TetMesh boxWithFields(TetMesh mesh = boxSample()) {
  MeshField swirl{"Swirl", 3, "float32", {}, "point"}, label{"Label", 1, "int32", {}, "cell"},
      height{"Height", 1, "float64", {}, "cell"};
  for (const Position& p : mesh.points)
    for (const double x : {p[1] - 0.5, 0.5 - p[0], p[2] * p[2]})
      swirl.values.push_back(static_cast<float>(x));
  for (const Tetrahedron& cell : mesh.tetrahedra) {
    const Position& p = mesh.points[cell[0]];
    label.values.push_back(std::floor(p[0] * 3) + 10);
    height.values.push_back(p[2] + 0.1 * p[1]);
  }
  mesh.fields.insert(mesh.fields.end(), {swirl, label, height});
  return mesh;
}

}  // namespace qtet::testing
