// Meshes as files of the kind that the file's name asks for.
#pragma once

#include <filesystem>

#include "codec/file_mesh.h"
#include "proto/bytes.h"
#include "proto/error.h"
#include "simplify/tet_mesh.h"

namespace qtet {

/// "`.vtu .vtk ...`": every ending that a mesh can be written with, for checkOutput and messages.
inline constexpr const char* kWrittenEndings = ".vtu .vtk .msh .stl .ply .obj .glb .drc .usda .npz";

/// Coordinates as float32 if that loses nothing, else float64. `mesh` must outlive the answer.
[[nodiscard]] FileMesh fileMesh(const TetMesh& mesh);

[[nodiscard]] Bytes vtuBytes(const TetMesh& mesh);

/// The mesh as a file of `output`'s kind: codec/vtu_writer.h, mesh_file.h, boundary_glb.h, boundary_drc.h. Those two put a mesh in floats on a lattice of 16 bits an axis,
/// its fields on 16 bits. REQUIRES: an ending of kWrittenEndings. Errors: the writers'; bad-input, where a mesh that is to go on a lattice is none.
[[nodiscard]] Result<Bytes> meshFileBytes(const TetMesh& mesh, const std::filesystem::path& output);
[[nodiscard]] Result<Bytes> meshFileBytes(const LatticeMesh& mesh, const std::filesystem::path& output);

}  // namespace qtet
