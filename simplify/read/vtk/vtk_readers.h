// VTK's reader of each format, set up to read everything that a mesh can have.
#pragma once

#include <vtkAlgorithm.h>
#include <vtkSmartPointer.h>

#include <filesystem>

#include "simplify/read/options/mesh_format.h"
#include "simplify/read/options/read_options.h"

namespace qtet {

/// It may have looked at the file already, and told VTK's message window what it thinks of it.
/// REQUIRES: a format that VTK reads, and no list of files.
[[nodiscard]] vtkSmartPointer<vtkAlgorithm> vtkReaderOf(const std::filesystem::path& path,
                                                        MeshFormat format,
                                                        const ReadOptions& options);

}  // namespace qtet
