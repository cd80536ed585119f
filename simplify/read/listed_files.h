// A series whose steps are numbered files that no file lists: several names, a pattern, a folder.
#pragma once

#include <filesystem>

#include "proto/error.h"
#include "simplify/read/options/read_options.h"

namespace qtet {

/// Whether the name is a folder's, or a pattern of *, ? and [ ] and no file's.
[[nodiscard]] bool namesFiles(const std::filesystem::path& path);

/// The options with the files that they or the path name, each with its time, ascending. Times are
/// `listed.times`. Without these they are the files' TimeValue where all have one, else the numbers
/// in their names. The options stay as they are where the path is one file without a given time, or
/// a case of OpenFOAM. They also stay where the files are checked already. Errors: not-found (no
/// such file), those of checkMeshFile and of readVtuDocument; bad-input (files of several kinds, or
/// that no list of VTK's may name; a file without a time; two of one time; a folder of several
/// names), bad-value (times of another number, or against the order of the files' numbers).
[[nodiscard]] Result<ReadOptions> withListedFiles(const std::filesystem::path& path,
                                                  const ReadOptions& options);

}  // namespace qtet
