// Puts the contents of a pipe into a file: VTK's readers, and logs, want to be read from any place.
#pragma once

#include <memory>
#include <string_view>

#include "proto/error.h"
#include "simplify/read/process/guarded_folder.h"
#include "simplify/words/console.h"

namespace qtet {

/// The file's name, without its ending.
inline constexpr const char* kPipedFile = "standard-input";

/// Bytes of the standard input at most: more than a mesh of kMaxElements cells has as .vtu, and an
/// endless pipe ends.
inline constexpr std::uint64_t kMaxPipedBytes = std::uint64_t{64} << 30;

/// Replaces the word "-" by the name of a temporary file, which holds what `input` gives until its
/// end. The file exists as long as the answer does. The name of a pipe (a named one, <(...),
/// /dev/stdin) means what the pipe gives likewise. A word that is an option's, as -o -, is none of
/// these. A mesh may be compressed by gzip. nullptr: there was no such word. `ending` names the
/// file: of a command that reads logs "qtet", else empty, and --format among the words says it, or
/// the pipe's name. Errors: bad-input (more than one such word, no --format), limit-exceeded (more
/// than `most` bytes), truncated (no bytes), io (a terminal, no room).
[[nodiscard]] Result<std::unique_ptr<GuardedFolder>> spoolStandardInput(
    Words& words, std::string_view ending, int input, std::uint64_t most = kMaxPipedBytes);

}  // namespace qtet
