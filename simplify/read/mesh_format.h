// The kinds of mesh files, told by their names, and what can be told about a file before a reader
// that trusts its input parses it.
#pragma once

#include <filesystem>

#include "proto/error.h"

namespace qtet {

enum class MeshFormat {
  kVtu,
  kPvtu,
  kVtm,
  kPvd,
  kVts,
  kVtr,
  kVti,
  kLegacyVtk,  // VTK's own
  kExodus,
  kEnSight,
  kCgns,
  kAvsUcd,
  kOpenFoam,
  kPlot3d,  // through VTK
  kGmsh,
  kMedit,
  kTetgen,
  kSu2,  // our own readers
  // through meshio, if it knows them
  kOther,
};

/// By the name's ending, in small or capital letters.
[[nodiscard]] MeshFormat formatOf(const std::filesystem::path& path);

/// Looks at existence, size, first and last bytes. Errors: not-found (no such file), io (not
/// readable, a folder), truncated (empty, or the XML's closing tag is missing), bad-input (not what
/// the ending promises).
[[nodiscard]] Status checkMeshFile(const std::filesystem::path& path, MeshFormat format);

}  // namespace qtet
