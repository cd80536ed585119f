// The kinds of mesh files by their names, and what can be said about a file before a reader that
// trusts its input parses it.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "proto/error.h"

namespace qtet {

/// The reader of each stands in read_steps.cpp.
enum class MeshFormat {
  kVtu,
  kVts,
  kVtr,
  kVti,
  kPvtu,
  kPvts,
  kPvtr,
  kPvti,
  kVtm,
  kPvd,
  kSeries,
  kLegacyVtk,  // VTK's own
  kVtkHdf,
  kExodus,
  kExodusPieces,
  kEnSight,
  kCgns,
  kAvsUcd,
  kOpenFoam,
  kFluent,
  kXdmf,
  kPlot3d,
  kGmsh,
  kMedit,
  kTetgen,
  kSu2,
  kUnv,
  kAbaqus,
  kNastran,
  kAnsys,
  kOther,  // whatever meshio knows
};

/// What holds for all files of a format.
struct FormatTraits {
  MeshFormat format = MeshFormat::kOther;
  std::string_view endings{};  ///< ".e .exo": those by which its files are known
  std::string_view root{};     ///< the type that the root of VTK's XML states
  bool standsAlone = false;    ///< names no other file, so that it may be compressed
  bool mayBePart = false;      ///< a list of VTK's may name it as a part of a mesh
  bool mayBeStep = false;      ///< numbered files of it may be a series
  bool namesPieces = false;    ///< a summary that names the pieces of one mesh
  bool isSeries = false;       ///< lists files with their times
};
[[nodiscard]] const FormatTraits& traitsOf(MeshFormat format);

/// Decides by the name's ending, in small or capital letters; kExodusPieces: by the last two
/// (piece_files.h).
[[nodiscard]] MeshFormat formatOf(const std::filesystem::path& path);

/// The format of a file whose ending means `named`. Its first characters tell apart what shares an
/// ending: Abaqus and AVS, Gmsh, Fluent and ANSYS. A file that cannot be read stays `named`.
[[nodiscard]] MeshFormat formatOfContent(const std::filesystem::path& path, MeshFormat named);

/// The endings that formatOf knows, as --format takes them: "vtu, pvtu, ...".
[[nodiscard]] std::string knownEndings();

/// Looks at existence, size, first and last bytes; all lines of AVS UCD (check_avs.h). Errors:
/// not-found (no such file), io (not readable, a folder), truncated (empty, or its end is missing),
/// bad-input (not what the ending promises).
[[nodiscard]] Status checkMeshFile(const std::filesystem::path& path, MeshFormat format);

}  // namespace qtet
