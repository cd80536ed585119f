// Writing a file so that readers see the old one or the whole new one, never a part, even after a
// crash.
#pragma once

#include <filesystem>
#include <functional>
#include <string_view>

#include "codec/files/file_calls.h"
#include "proto/bytes.h"
#include "proto/error.h"

namespace qtet {

/// Writes a new file beside `path`, flushes it to the disk, renames it over `path` and flushes the
/// folder. After an error `path` is as it was and nothing is left beside it; only if the very last
/// step fails, the flush of the folder, `path` is the whole new file, and the message says so. A
/// process that is killed on its way leaves at most `.NAME.*.tmp`, which the next write of the same
/// `path` removes (each writer holds a lock on its own, so those of writers at work are let alone).
/// Several processes may write the same `path`: one of the whole files wins. A file that is
/// replaced hands on its permissions. A symbolic link stays: the file that it leads to is replaced,
/// or made. Errors: not-found (the folder does not exist), io (no regular file is there; with the
/// file and the operating system's reason).
[[nodiscard]] Status writeFileAtomically(const std::filesystem::path& path, ByteView bytes,
                                         FileCalls& calls = systemFileCalls());

/// The file that writing to `path` makes or replaces: behind every symbolic link, whether it is
/// there or not. Errors: io (a circle of links).
[[nodiscard]] Result<std::filesystem::path> fileBehindLinks(const std::filesystem::path& path);

/// Removes what writers that were killed left in `folder` of the files whose names `isOurs`
/// accepts, of at most 190 bytes. Those of writers at work are let alone, whichever process they
/// belong to: each holds a lock on its own. What cannot be removed does no harm.
void removeUnfinished(const std::filesystem::path& folder,
                      const std::function<bool(std::string_view name)>& isOurs,
                      FileCalls& calls = systemFileCalls());

}  // namespace qtet
