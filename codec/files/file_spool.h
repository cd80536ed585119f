// A spool on disk, in a file without a name: nothing is left of it, not even by a process that is
// killed.
#pragma once

#include <filesystem>
#include <memory>

#include "codec/files/byte_spool.h"
#include "codec/files/file_calls.h"

namespace qtet {

/// In the folder of `beside`, a file that is or will be there; behind its symbolic links. Takes
/// 1 MB of memory. Errors: not-found (the folder does not exist), io.
[[nodiscard]] Result<std::unique_ptr<ByteSpool>> fileSpoolBeside(
    const std::filesystem::path& beside, FileCalls& calls = systemFileCalls());

}  // namespace qtet
