// What can be told about a mesh file before VTK, which trusts its input, parses it.
#pragma once

#include <filesystem>

#include "proto/error.h"

namespace qtet {

enum class VtkFormat { kXml, kLegacy };

/// Looks at existence, extension, size, first and last bytes. Errors: not-found (no such file), io (not readable, a folder),
/// truncated (empty, or the XML's closing tag is missing), bad-input (another extension, or not what the extension promises).
[[nodiscard]] Result<VtkFormat> checkVtkFile(const std::filesystem::path& path);

}  // namespace qtet
