// Writing a file so that readers see the old one or the whole new one, never a part, even after a
// crash.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string_view>

#include "codec/files/file_calls.h"
#include "proto/byte_sink.h"

namespace qtet {

/// Writes a new file beside `path`, flushes it to the disk, renames it over `path` and flushes the
/// folder. After an error `path` is as it was and nothing is left beside it. There is one
/// exception: if the last step fails, the flush of the folder, `path` is the whole new file, and
/// the message says so. A process that is killed meanwhile leaves at most `.NAME.*.tmp`, which the
/// next write of the same `path` removes. Each writer locks its own file, so the files of running
/// writers stay. Several processes may write the same `path`: one of the whole files wins. The new
/// file takes the permissions of the one that it replaces. A symbolic link stays: the file that it
/// leads to is replaced, or made. Errors: not-found (the folder does not exist), io (no regular
/// file is there; with the file and the operating system's reason).
[[nodiscard]] Status writeFileAtomically(const std::filesystem::path& path, ByteView bytes,
                                         FileCalls& calls = systemFileCalls());
/// Whether writers that were killed are cleaned up after, which looks at every file of the folder.
enum class Leftovers : std::uint8_t { kRemove, kKeep };
/// The same of bytes that come in pieces. Errors: also those of `content`.
[[nodiscard]] Status writeFileAtomically(const std::filesystem::path& path,
                                         const ByteSource& content,
                                         FileCalls& calls = systemFileCalls(),
                                         Leftovers leftovers = Leftovers::kRemove);

/// The file that writing to `path` makes or replaces: behind every symbolic link, whether it is
/// there or not. Errors: io (a circle of links).
[[nodiscard]] Result<std::filesystem::path> fileBehindLinks(const std::filesystem::path& path);

/// The folder of that file. Errors: also not-found (there is no such folder), io (it cannot be
/// reached, with the operating system's reason).
[[nodiscard]] Result<std::filesystem::path> folderBehindLinks(const std::filesystem::path& path);

/// Removes from `folder` the unfinished files of writers that were killed, if `isOurs` accepts
/// their names, of at most 190 bytes. Each writer locks its own file, so the files of running
/// writers stay, in every process. A file that cannot be removed does no harm.
void removeUnfinished(const std::filesystem::path& folder,
                      const std::function<bool(std::string_view name)>& isOurs,
                      FileCalls& calls = systemFileCalls());

}  // namespace qtet
