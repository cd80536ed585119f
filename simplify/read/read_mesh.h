// Reading meshes of every format that qtet knows as tetrahedra. Only the folder vtk uses VTK.
#pragma once

#include <filesystem>

#include "proto/error.h"
#include "simplify/mesh/tet_mesh.h"
#include "simplify/read/options/read_options.h"

namespace qtet {

struct ReadMesh {
  TetMesh mesh;
  ReadReport report;
};

/// The file's cells with the fields asked for, as its reader gives them: not even their ids are
/// checked. Errors: as readMesh's.
[[nodiscard]] Result<CellMesh> readStoredCells(const std::filesystem::path& path,
                                               const ReadOptions& options, ReadReport& report);

/// The file's cells before they are split, checked, welded and cut by the threshold as the options
/// say. Errors: as readMesh's.
[[nodiscard]] Result<CellMesh> readCells(const std::filesystem::path& path,
                                         const ReadOptions& options, ReadReport& report);

/// Splits what readCells gave, mends it after welding, and leaves the fields asked for.
[[nodiscard]] Result<TetMesh> tetrahedraOf(CellMesh&& cells, const std::filesystem::path& path,
                                           const ReadOptions& options, ReadReport& report);

/// Reads volume cells as tetrahedra (split_cells.h), points and fields, with the file's numbering.
/// In a file of tetrahedra alone `mesh.tetrahedra[i]` is the i-th of them. Cells of lower dimension
/// are skipped, with their values. Vertex ids are checked. Field values keep NaN and infinity;
/// coordinates must be finite. After welding, faces that two tetrahedra's cells cut differently are
/// cut alike (mend_faces.h). Errors: those of checkMeshFile; bad-input (the reader's own message; a
/// kind of cell that is not read; no volume cells; a coordinate that is not finite; a vertex id
/// outside the points; an integer of 2^53 or more in magnitude in a field asked for by name),
/// not-found (no field or time step of that name; a program that is not installed), limit-exceeded.
/// Not thread-safe: VTK's message
/// window is global.
[[nodiscard]] Result<ReadMesh> readMesh(const std::filesystem::path& path,
                                        const ReadOptions& options);
[[nodiscard]] Result<ReadMesh> readMesh(const std::filesystem::path& path,
                                        const FieldNames& fields = std::nullopt);

}  // namespace qtet
