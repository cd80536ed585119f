// Running VTK's readers: their errors and warnings as values, their crashes as errors.
#pragma once

#include <vtkSmartPointer.h>
#include <vtkUnstructuredGrid.h>

#include <filesystem>
#include <string>
#include <vector>

#include "proto/error.h"

namespace qtet {

/// What VTK makes of the file, never null, unchecked beyond what VTK itself checks. Warnings are appended to `notes`.
/// Errors: checkVtkFile's; bad-input with VTK's first error, or where VTK crashes or runs out of memory.
/// Not thread-safe: VTK's message window is global. Leaves VTK's logging to stderr switched off.
[[nodiscard]] Result<vtkSmartPointer<vtkUnstructuredGrid>> readVtkGrid(const std::filesystem::path& path, std::vector<std::string>& notes);

}  // namespace qtet
