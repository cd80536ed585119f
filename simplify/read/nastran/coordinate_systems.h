// Nastran's coordinate systems: where GRID points and other systems lie.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "proto/error.h"
#include "simplify/read/abaqus/placement.h"
#include "simplify/read/text/plain_numbers.h"

namespace qtet {

enum class SystemKind : std::uint8_t { kRectangular, kCylindrical, kSpherical };

/// A CORD1x or CORD2x card.
struct SystemCard {
  SystemKind kind = SystemKind::kRectangular;
  bool isByGrids = false;                ///< CORD1x: by three points of the mesh
  std::uint32_t reference = 0;           ///< CORD2x: the system of `points`; 0: the basic one
  std::array<Position, 3> points{};      ///< CORD2x: origin, one on z, one in the plane x-z
  std::array<std::uint32_t, 3> grids{};  ///< CORD1x: the same, as numbers of points
};

/// A GRID card.
struct GridCard {
  std::uint32_t number = 0, system = 0;
  Position place{};
  friend bool operator==(const GridCard&, const GridCard&) = default;
};

/// All points of a file and the systems that they are given in.
struct PlacedGrids {
  std::vector<GridCard> grids;
  NumberTable rows;  ///< of grids, by their numbers
  std::map<std::uint32_t, SystemCard> systems;

  /// Systems that refer to one another are followed so deep.
  static constexpr int kMaxDepth = 64;

  /// The points in the basic system, in the order of `grids`. Errors, without the file's name:
  /// bad-input (a system that is not there, refers to itself, or whose points define none),
  /// limit-exceeded.
  [[nodiscard]] Result<std::vector<Position>> places() const;
};

}  // namespace qtet
