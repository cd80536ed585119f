// A tetrahedral mesh as its file has it: positions in floats, fields on points. What is read, cleaned, written; simplifying needs a lattice (quantise.h).
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "codec/mesh.h"

namespace qtet {

using Position = std::array<double, 3>;

/// components * points numbers, point by point, each representable in `type`.
struct PointField {
  std::string name;
  std::uint32_t components = 1;
  std::string type = "float32";  ///< float32, float64, int8, uint8 ... int64, uint64 (up to 2^53 in magnitude)
  std::vector<double> values;
};

struct TetMesh {
  std::vector<Position> points;
  std::vector<Tetrahedron> tetrahedra;
  std::vector<PointField> fields;
};

/// Whether a PointField's or FieldInfo's type is one of floats.
[[nodiscard]] inline bool isFloatType(const std::string& type) { return type == "float32" || type == "float64"; }

}  // namespace qtet
