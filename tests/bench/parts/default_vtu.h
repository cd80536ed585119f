// Writes a mesh as VTK does when nobody asks for anything special: a web page would send this file
// without qtet.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "proto/error.h"

namespace qtet::bench {

struct DefaultVtu {
  /// The first point field, the only one that is kept; empty where there is none.
  std::string field;
  std::uint64_t cells = 0;  ///< of the file, of whatever kind
  std::uint64_t bytes = 0;
};

/// The size of a .vtu from vtkXMLUnstructuredGridWriter as it comes (zlib in blocks of 32 KB,
/// base64) with 64-bit ids, the points and the first point field. Errors: bad-input (not a .vtu
/// that VTK reads).
[[nodiscard]] Result<DefaultVtu> defaultVtu(const std::filesystem::path& path);

}  // namespace qtet::bench
