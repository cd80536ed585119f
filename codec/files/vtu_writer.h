// Meshes as VTK XML files (.vtu) for ParaView and everything that reads VTK, without VTK.
#pragma once

#include "codec/files/file_mesh.h"
#include "proto/byte_sink.h"

namespace qtet {

/// Between a cell field's name and that of a value: the array "Material=steel" holds the value.
inline constexpr char kLabelNameSign = '=';

/// One UnstructuredGrid piece of tetrahedra: appended raw, little-endian, ids as Int32 (Int64 where
/// they do not fit), array sizes as UInt32 (UInt64 where an array has 4 GiB or more). Names of
/// labels are among the data of the file. The first scalar field of the points and that of the
/// cells are the active ones. Deterministic: no dates, no names of machines. One array at a time is
/// in memory. Errors: the sink's.
[[nodiscard]] Status writeVtu(const FileMesh& mesh, const ByteSink& sink);
[[nodiscard]] Bytes vtuBytes(const FileMesh& mesh);

/// A mesh on the lattice, as fileMesh() has it.
[[nodiscard]] Bytes vtuBytes(const LatticeMesh& mesh);

}  // namespace qtet
