// The keywords of an Abaqus or CalculiX file that make its mesh.
#pragma once

#include <chrono>
#include <filesystem>

#include "proto/error.h"
#include "simplify/read/abaqus/abaqus_model.h"

namespace qtet {

/// Reads the file and what it includes, up to the first *STEP. Keywords of materials, loads and
/// output are skipped. Errors: io, not-found (an included file), limit-exceeded, truncated,
/// bad-input, each with the line.
[[nodiscard]] Result<AbaqusModel> readAbaqusModel(const std::filesystem::path& path,
                                                  std::chrono::seconds patience);

}  // namespace qtet
