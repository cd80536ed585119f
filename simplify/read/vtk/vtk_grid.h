// Running VTK's readers: their errors and warnings as values, their crashes as errors, their time
// steps and blocks.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "simplify/read/options/mesh_format.h"
#include "simplify/read/options/read_options.h"
#include "simplify/split/cell_mesh.h"

namespace qtet {

/// One time step: what it is called ("0.5"; empty: the file knows no time), and its mesh in one
/// piece.
struct TimedCells {
  std::string time;
  CellMesh cells;
};

/// The meshes that VTK makes of the file, unchecked beyond what VTK itself checks. They are the
/// step or steps that `options.time` asks for, all blocks of each in one mesh (join_blocks.h).
/// Warnings become notes.
/// Errors: bad-input with VTK's first error, or where VTK crashes or runs out of memory; not-found
/// (a time that is none; a file that the file names); those of cellsOf. REQUIRES: a file that
/// checkMeshFile has passed.
/// Not thread-safe: VTK's message window is global. Leaves VTK's logging to stderr switched off.
[[nodiscard]] Result<std::vector<TimedCells>> readVtk(const std::filesystem::path& path,
                                                      MeshFormat format, const ReadOptions& options,
                                                      ReadReport& report);

}  // namespace qtet
