// Where Abaqus puts nodes: local coordinate systems, and instances that are moved and turned.
#pragma once

#include <array>
#include <optional>
#include <span>

#include "simplify/mesh/tet_mesh.h"

namespace qtet {

/// Turns by the columns of a matrix, then moves.
struct AbaqusPlacement {
  std::array<Position, 3> axes{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};  ///< where the axes go
  Position origin{0, 0, 0};

  [[nodiscard]] Position operator()(const Position& p) const;
};

/// Sine and cosine of degrees, by + - * / alone: the same bits on every machine, and exact for
/// multiples of 90.
struct Turn {
  double sine = 0, cosine = 1;
};
[[nodiscard]] Turn turnOf(double degrees);

/// From (radius, degrees, z), and from (radius, degrees round Z, degrees above the plane X-Y).
[[nodiscard]] Position fromCylindrical(const Position& p);
[[nodiscard]] Position fromSpherical(const Position& p);

/// *SYSTEM: the numbers of its lines. Three give the origin. Six: also a point of the new X axis,
/// whose part along Z does not count. Nine: also a point of the new plane X-Y. nullopt: the points
/// define no system.
[[nodiscard]] std::optional<AbaqusPlacement> systemOf(std::span<const double> numbers);

/// *INSTANCE: moved by `shift`, then turned by the seven numbers of `turn`: two points of the axis,
/// and degrees. An empty `turn` does nothing. nullopt: the points define no axis.
[[nodiscard]] std::optional<AbaqusPlacement> instanceAt(const Position& shift,
                                                        std::span<const double> turn);

}  // namespace qtet
