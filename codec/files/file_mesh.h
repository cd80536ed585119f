// A mesh in floats, as the writers of mesh files take it.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "codec/files/field_numbers.h"
#include "codec/mesh/mesh.h"
#include "proto/error.h"

namespace qtet {

/// A field to write; `values` holds components numbers a point, or a tetrahedron for a cell field.
struct FileField {
  std::string name;
  /// Float32, float64, int8 ... uint64; other names are written as float64.
  std::string type = "float32";
  std::uint32_t components = 1;
  FieldNumbers values;  ///< rounded and clamped to the type
  /// For colours: of vectors that of the magnitude; without it that of the values.
  std::optional<std::array<double, 2>> range{};
  LabelNames labelNames{};  ///< as FieldInfo's
};

/// The contents of a mesh file. The viewed arrays must outlive the writer.
struct FileMesh {
  std::span<const std::array<double, 3>> points;
  std::span<const Tetrahedron> tetrahedra;
  bool doublePoints = true;  ///< coordinates as float64, else float32, where a format knows both
  std::vector<FileField> pointFields{};
  std::vector<FileField> cellFields{};
};

/// A mesh on the lattice in its own units, with the points that `mesh` looks at.
struct LatticeFileMesh {
  std::vector<std::array<double, 3>> points;
  FileMesh mesh;
};

/// Fields keep their types; a missing value is NaN. Coordinates are float32 if each of them still
/// rounds to its lattice point, round((x - origin) / step). Else they are float64, which always
/// does. So the lattice survives exactly. `mesh` must outlive the answer, whose fields are made of
/// its integers when they are written.
[[nodiscard]] LatticeFileMesh fileMesh(const LatticeMesh& mesh);
/// The field without its numbers.
[[nodiscard]] FileField fileField(const FieldInfo& info);
/// The numbers of a field's integers.
[[nodiscard]] std::vector<double> dequantised(const FieldInfo& info,
                                              std::span<const std::int32_t> integers);

/// Errors: bad-input (a coordinate that float32 does not hold, for formats of nothing else;
/// `format` is ".glb").
[[nodiscard]] Status fitsFloats(std::span<const std::array<double, 3>> points, const char* format);

/// The boundary of a mesh with the points that it uses, renumbered in their order, and its point
/// fields.
struct FileSurface {
  std::vector<std::array<double, 3>> points;
  std::vector<Triangle> triangles;  ///< counter-clockwise seen from outside
  std::vector<FileField> fields;
};

[[nodiscard]] FileSurface surfaceOf(const FileMesh& mesh);

}  // namespace qtet
