// Writing a file so that readers see the old one or the whole new one, never a part, even after a crash.
#pragma once

#include <filesystem>

#include "proto/bytes.h"
#include "proto/error.h"

namespace qtet {

/// Writes a new file beside `path`, flushes it to the disk, renames it over `path` and flushes the folder. After an error `path` is as
/// it was and nothing is left beside it. Errors: not-found (the folder does not exist), io (with the operating system's reason).
[[nodiscard]] Status writeFileAtomically(const std::filesystem::path& path, ByteView bytes);

}  // namespace qtet
