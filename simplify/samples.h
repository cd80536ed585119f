// Meshes that are made, not read: for trying the tool without data, for tests and for the demo. The same bits on every machine,
// because nothing but + - * / sqrt and rounding to float32 goes into them.
#pragma once

#include <span>
#include <string_view>

#include "proto/error.h"
#include "simplify/tet_mesh.h"

namespace qtet {

struct Sample {
  std::string_view name;
  std::string_view description;
  TetMesh (*make)();
};

/// All samples, in the order in which help shows them.
[[nodiscard]] std::span<const Sample> samples();

/// Errors: not-found, with the names there are.
[[nodiscard]] Result<TetMesh> makeSample(std::string_view name);

/// The unit cube in 8 x 8 x 8 cells of 6 Kuhn tetrahedra: 729 points, 3,072 tetrahedra; field Scalar = sin(2 pi x) cos(pi y) + z^2.
[[nodiscard]] TetMesh boxSample();

/// A supersonic stream round a swept blunt fin on a plate, an algebraic model of one: bow shock, boundary layers, tip and horseshoe vortices,
/// a meandering wake. 212,544 tetrahedra in layers that grow from the wall; fields Density, Pressure, Velocity (free stream: 1, 1/1.4, Mach 2.95).
[[nodiscard]] TetMesh finSample();

}  // namespace qtet
