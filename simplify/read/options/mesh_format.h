// The kinds of mesh files by their names, and what can be said about a file before a reader that
// trusts its input parses it.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "proto/error.h"

namespace qtet {

enum class MeshFormat {
  kVtu,
  kPvtu,
  kPvts,
  kPvtr,
  kPvti,
  kVtm,
  kPvd,
  kSeries,
  kVts,
  kVtr,
  kVti,
  kLegacyVtk,  // VTK's own
  kExodus,
  kExodusPieces,
  kEnSight,
  kCgns,
  kAvsUcd,
  kOpenFoam,
  kFluent,
  kVtkHdf,
  kXdmf,    // our own reader, or meshio
  kPlot3d,  // through VTK
  kGmsh,
  kMedit,
  kTetgen,
  kSu2,
  kUnv,
  kNastran,  // our own readers
  // through meshio, if it knows them
  kOther,
};

/// Decides by the name's ending, in small or capital letters; kExodusPieces: by the last two
/// (piece_files.h).
[[nodiscard]] MeshFormat formatOf(const std::filesystem::path& path);

/// The endings that formatOf knows, as --format takes them: "vtu, pvtu, ...".
[[nodiscard]] std::string knownEndings();

/// Whether it is a summary of VTK's XML, which names the pieces of one mesh.
[[nodiscard]] bool namesPieces(MeshFormat format);

/// The type that the root of VTK's XML states, such as UnstructuredGrid; empty: no such format.
[[nodiscard]] std::string_view rootType(MeshFormat format);

/// Looks at existence, size, first and last bytes; all lines of AVS UCD (check_avs.h). Errors:
/// not-found (no such file), io (not readable, a folder), truncated (empty, or its end is missing),
/// bad-input (not what the ending promises).
[[nodiscard]] Status checkMeshFile(const std::filesystem::path& path, MeshFormat format);

}  // namespace qtet
