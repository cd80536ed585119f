// Files that neither VTK nor we read, through the Python library meshio
// (https://github.com/nschloe/meshio), if it is installed.
#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <string>

#include "proto/error.h"

namespace qtet {

/// The input that meshio is to read.
struct MeshioInput {
  std::filesystem::path path;
  /// An ending without dot, or one of meshio's own words such as ansys; empty: as the name says.
  std::string kind;
  std::string time = "last";          ///< as ReadOptions::time
  std::chrono::seconds patience{60};  ///< as ReadOptions::patience
};

/// Runs meshio as a program of its own, which writes the input as a .vtu file in a folder of its
/// own. It writes a series of XDMF as a .pvd file that names all steps, with the .vtu files of
/// those that `time` means. Hands the file to `use`, then removes the folder. Errors: not-found (no
/// Python, or no meshio: the message says what to install), bad-input (meshio's own last words; a
/// kind of file that nothing reads; no byte moved for `patience`), io, those of `use`.
[[nodiscard]] Status throughMeshio(const MeshioInput& input,
                                   const std::function<Status(const std::filesystem::path&)>& use);

}  // namespace qtet
