// The words that every part of the codec shares: ids, lattice points, cells with a ghost vertex,
// and a mesh on the lattice.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "codec/mesh/time_parents.h"
#include "proto/field_name.h"
#include "proto/label_names.h"

namespace qtet {

using VertexId = std::uint32_t;
using CellId = std::uint32_t;

/// The vertex "outside": every boundary triangle (a, b, c), counter-clockwise seen from outside, is
/// the cell (a, b, c, kGhost).
inline constexpr VertexId kGhost = 0xFFFFFFFFu;

/// Four vertices; (b-a) x (c-a) . (d-a) > 0 for a cell that is not degenerate, the orientation of
/// VTK_TETRA.
using Tetrahedron = std::array<VertexId, 4>;
/// Three vertices, counter-clockwise seen from outside.
using Triangle = std::array<VertexId, 3>;
/// Lattice coordinates, each in [0, 2^bits).
using LatticePoint = std::array<std::int32_t, 3>;

/// Numbers of slots of each kind: a place in all three arrays, or counts.
struct Slots {
  std::uint32_t vertices = 0, tetrahedra = 0, triangles = 0;

  [[nodiscard]] bool within(const Slots& end) const {
    return vertices <= end.vertices && tetrahedra <= end.tetrahedra && triangles <= end.triangles;
  }
  bool operator==(const Slots&) const = default;
};

/// position = origin + step * lattice point, the same step on every axis.
struct Lattice {
  int bits = 16;
  double step = 1;
  std::array<double, 3> origin{};

  [[nodiscard]] std::array<double, 3> position(const LatticePoint& p) const {
    return {origin[0] + step * p[0], origin[1] + step * p[1], origin[2] + step * p[2]};
  }
};

/// Stands for a missing value (NaN) among the integers of a field with missing values. No value can
/// be this small.
inline constexpr std::int32_t kMissing = std::numeric_limits<std::int32_t>::min();

/// The meaning of a field's integers: value of component c = minimum[c] + step * integer. Integer
/// fields have step 1 and lose nothing.
struct FieldInfo {
  FieldName name;
  std::uint32_t components = 1;
  std::string type = "float32";  ///< of the input: float32, float64, int8 ... uint64
  /// The element that a value belongs to: point or cell (a tetrahedron).
  std::string association = "point";
  int bits = 12;  ///< integers lie in [0, 2^bits)
  double step = 1;
  std::vector<double> minimum;  ///< one a component
  /// The range of the values, or of their magnitude if components > 1.
  std::array<double, 2> range{0, 0};
  /// An integer may be kMissing: a value that is NaN.
  bool hasMissing = false;
  /// In a history that holds differences in time: what they are differences to.
  TimePrediction prediction{};
  /// The names of a label's values, as far as its file has some.
  LabelNames labelNames{};

  /// The value of an integer of the component; NaN for a missing value.
  [[nodiscard]] double value(std::size_t component, std::int32_t integer) const {
    return integer == kMissing ? std::numeric_limits<double>::quiet_NaN()
                               : minimum[component] + step * integer;
  }
};

/// Whether the field's values belong to tetrahedra instead of points.
[[nodiscard]] inline bool isCellField(const FieldInfo& field) {
  return field.association == "cell";
}

/// A mesh on the lattice with quantised fields; `values[f]` holds components integers a point, or a
/// tetrahedron for a cell field.
struct LatticeMesh {
  Lattice lattice;
  std::vector<LatticePoint> points;
  std::vector<Tetrahedron> tetrahedra;
  std::vector<Triangle> boundary;
  std::vector<FieldInfo> fields;
  std::vector<std::vector<std::int32_t>> values;
};

}  // namespace qtet
