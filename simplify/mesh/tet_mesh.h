// A tetrahedral mesh as its file has it: positions in floats, fields on points and cells. It is
// read, cleaned and written; simplifying needs a lattice (quantise.h).
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "codec/mesh/mesh.h"
#include "proto/field_name.h"

namespace qtet {

using Position = std::array<double, 3>;

/// components numbers a point, or a tetrahedron for a cell field, in their order, each
/// representable in `type`.
struct MeshField {
  FieldName name;
  std::uint32_t components = 1;
  /// Float32, float64, int8, uint8 ... int64, uint64 (up to 2^53 in magnitude).
  std::string type = "float32";
  std::vector<double> values;
  std::string association = "point";  ///< point or cell
  /// The file's names of values: those of materials, blocks, groups.
  LabelNames labelNames{};
};

[[nodiscard]] inline MeshField withoutValues(const MeshField& field) {
  return {.name = field.name,
          .components = field.components,
          .type = field.type,
          .values = {},
          .association = field.association,
          .labelNames = field.labelNames};
}

struct TetMesh {
  std::vector<Position> points;
  std::vector<Tetrahedron> tetrahedra;
  std::vector<MeshField> fields;
  /// Float32 or float64; empty: unknown, the narrowest that holds the points.
  std::string pointType{};
};

/// Whether a MeshField's or FieldInfo's type is one of floats.
[[nodiscard]] inline bool isFloatType(const std::string& type) {
  return type == "float32" || type == "float64";
}

/// Whether the field's values belong to tetrahedra instead of points.
[[nodiscard]] inline bool isCellField(const MeshField& field) {
  return field.association == "cell";
}

}  // namespace qtet
