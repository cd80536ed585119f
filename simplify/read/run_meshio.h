// Files that neither VTK nor we read, through the Python library meshio
// (https://github.com/nschloe/meshio), if it is installed.
#pragma once

#include <filesystem>
#include <functional>

#include "proto/error.h"

namespace qtet {

/// Runs meshio as a program of its own, which writes `path` as a .vtu file in a folder of its own;
/// hands the file to `use`, then removes the folder. Errors: not-found (no Python, or no meshio:
/// the message says what to install), bad-input (meshio's own last words), io, those of `use`.
[[nodiscard]] Status throughMeshio(const std::filesystem::path& path,
                                   const std::function<Status(const std::filesystem::path&)>& use);

}  // namespace qtet
