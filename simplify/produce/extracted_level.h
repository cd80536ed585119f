// Makes the mesh files of one level of a log.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "proto/byte_sink.h"
#include "proto/error.h"
#include "proto/instants.h"
#include "proto/manifest.h"
#include "simplify/log/opened_log.h"
#include "simplify/words/mesh_output.h"

namespace qtet {

inline constexpr const char* kCollection = ".pvd";

/// Whether the output names files, one an instant.
[[nodiscard]] bool isCollection(const MeshOutput& output);

/// Takes each file as it is made.
using FileTaker = std::function<Status(const InstantFile& file, Bytes&& bytes)>;

/// The files that are made of the fields `wanted` among those that are known.
using FileChooser = std::function<Result<std::vector<InstantFile>>(
    const std::vector<ManifestField>& known, const std::vector<std::uint32_t>& wanted)>;

/// The files to make of a level.
struct LevelFiles {
  const MeshOutput& output;
  std::optional<std::vector<std::string>> fields;  ///< keys (field_key.h); nullopt: all
  FileChooser choose;
  FileTaker take;
};

/// Makes the files of the level. At the last level they are the input itself, as far as the log
/// kept it. Errors: that of `level`; not-found (no such field), meshAtLevel's, restoreInput's,
/// meshFileBytes's, and those of the two functions.
[[nodiscard]] Result<MeshOutputReport> extractLevel(const OpenedLog& log,
                                                    const Result<std::uint32_t>& level,
                                                    const LevelFiles& files);

}  // namespace qtet
