// Meshes as files of the kind that the file's name asks for.
#pragma once

#include <filesystem>

#include "codec/files/mesh_file.h"
#include "proto/bytes.h"
#include "proto/error.h"
#include "simplify/mesh/tet_mesh.h"

namespace qtet {

/// Coordinates as float32 if that loses nothing, else float64. `mesh` must outlive the answer.
[[nodiscard]] FileMesh fileMesh(const TetMesh& mesh);

[[nodiscard]] Bytes vtuBytes(const TetMesh& mesh);

/// The mesh as a file of `output`'s kind (codec/files/mesh_file.h). Where that needs the lattice,
/// the mesh is put on one of 16 bits an axis, its fields on 16 bits. REQUIRES: an ending of
/// kWrittenEndings. Errors: the writers'; bad-input, where a mesh that is to go on a lattice is
/// none.
[[nodiscard]] Result<Bytes> meshFileBytes(const TetMesh& mesh, const std::filesystem::path& output,
                                          const MeshFileOptions& file = {});

}  // namespace qtet
