// The log that a command shows: the one that is named, or one made of the mesh that is named.
#pragma once

#include <filesystem>
#include <string>

#include "simplify/words/parsed_words.h"

namespace qtet {

/// The mesh's name in an address: the file's name without its ending, in letters that need no
/// quoting there.
[[nodiscard]] std::string meshNameOf(const std::filesystem::path& file);

/// Makes the file `log` of `input`. A log is the same file under another name, or a copy where the
/// folder is on another disk. A mesh becomes one by `qtet simplify`. `parsed` has --fields and
/// the options of addReadOptions. (A symbolic link would not do: the server follows none out of its
/// folder.) Returns an exit code; what went wrong is reported.
[[nodiscard]] int provideLog(const std::filesystem::path& input, const std::filesystem::path& log,
                             const ParsedWords& parsed, Console& console);

}  // namespace qtet
