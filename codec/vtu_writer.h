// Meshes as VTK XML files (.vtu) for ParaView and everything that reads VTK, without VTK.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "codec/mesh.h"
#include "proto/bytes.h"

namespace qtet {

/// A field to write; `values` holds components numbers a point, or a tetrahedron for a cell field.
struct VtuField {
  std::string name;
  std::string type = "float32";  ///< float32, float64, int8 ... uint64; other names are written as float64
  std::uint32_t components = 1;
  std::vector<double> values;  ///< rounded and clamped to the type
};

/// What a .vtu file is made of; the views must outlive the call.
struct VtuMesh {
  std::span<const std::array<double, 3>> points;
  std::span<const Tetrahedron> tetrahedra;
  bool doublePoints = true;  ///< coordinates as Float64, else Float32
  std::vector<VtuField> pointFields{};
  std::vector<VtuField> cellFields{};
};

/// One UnstructuredGrid piece of tetrahedra: appended raw, little-endian, ids as Int32 (Int64 where they do not fit), array sizes as
/// UInt32 (UInt64 where an array has 4 GiB or more). The first scalar field of the
/// points and that of the cells are the active ones. Deterministic: no dates, no names of machines.
[[nodiscard]] Bytes vtuBytes(const VtuMesh& mesh);

/// A mesh on the lattice, in its own units, its fields in their own types. Coordinates are Float32 if each of them still rounds to its
/// lattice point, round((x - origin) / step), else Float64, which always does: so the lattice survives exactly.
[[nodiscard]] Bytes vtuBytes(const LatticeMesh& mesh);

}  // namespace qtet
