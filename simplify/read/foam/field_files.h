// The files of fields in a folder of a time.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>

#include "simplify/read/options/read_options.h"
#include "simplify/split/cell_mesh.h"

namespace qtet {

/// Adds the fields of cells and of points in the folder that `wanted` means, each called as its
/// file is. Symmetric tensors stand in VTK's order, xx yy zz xy yz xz. Files of no such field and
/// backups are skipped. Damaged gzip files are skipped with a note, and so is a field that a macro
/// gives. Errors: bad-input (a damaged file; no room; values for another number of cells or
/// points than the mesh has), io, truncated. `patience` holds for each file. `room` is the bytes
/// that values may take, less what they took: a file of few bytes can describe a uniform field of
/// any mesh.
[[nodiscard]] Status addFoamFields(const std::filesystem::path& folder, const FieldNames& wanted,
                                   std::chrono::seconds patience, std::uint64_t& room,
                                   CellMesh& mesh, ReadReport& report);

}  // namespace qtet
