// The faces and edges of VTK's cells.
#pragma once

#include <array>
#include <cstdint>
#include <span>

namespace qtet {

/// A face's corners, counter-clockwise seen from outside.
struct ShapeFace {
  std::uint8_t corners = 0;
  std::array<std::uint8_t, 6> corner{};
};

/// A linear cell. `faceNodes` and `edges` are for the curved cells built on it.
struct CellShape {
  std::uint8_t corners = 0;
  std::span<const ShapeFace> faces;
  /// The order in which a quadratic cell's nodes follow the corners.
  std::span<const std::array<std::uint8_t, 2>> edges;
};

/// The shape of a linear cell's type, or of the corners of a curved one's. A polyhedron, and a kind
/// that is not read, have no corners.
[[nodiscard]] CellShape shapeOf(std::uint8_t type);

inline constexpr std::uint8_t kNoNode = 0xFF;

/// Where a curved cell has its nodes besides the corners.
struct CurvedNodes {
  bool curved = false;
  std::span<const std::array<std::uint8_t, 2>> edges;  ///< edge i has node corners + i
  /// By face.
  std::array<std::uint8_t, 6> faceCentre{kNoNode, kNoNode, kNoNode, kNoNode, kNoNode, kNoNode};
  std::uint8_t centre = kNoNode;
};

[[nodiscard]] CurvedNodes curvedNodesOf(std::uint8_t type);

}  // namespace qtet
