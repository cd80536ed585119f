// Where a command writes its one file: -o NAME or -o -, and --no-clobber.
#pragma once

#include <filesystem>
#include <optional>
#include <ostream>
#include <string>

#include "proto/byte_sink.h"
#include "simplify/words/parsed_words.h"

namespace qtet {

struct Output {
  std::filesystem::path file;
  bool keepsOld = false;           ///< --no-clobber
  std::ostream* stream = nullptr;  ///< the standard output, where -o is "-"

  /// As reports and messages call it.
  [[nodiscard]] std::string name() const;
};

/// Adds --no-clobber.
void addNoClobber(po::options_description& options);

/// The file that -o names, and --no-clobber. REQUIRES: -o is given. Throws UsageError where --json
/// and the file both want the standard output.
[[nodiscard]] Output outputOf(const ParsedWords& parsed, const Console& console);

/// Refuses an output before the work is done. Its ending must be one of `extensions`, separated by
/// blanks (UsageError). Its folder must exist and be writable. It must not be the input itself, nor
/// with --no-clobber any file that is there. The standard output must not be a terminal.
[[nodiscard]] Status checkOutput(const Output& output, const std::string& extensions,
                                 const std::optional<std::filesystem::path>& input = std::nullopt);

/// Errors: io (there is such a file, and --no-clobber was given).
[[nodiscard]] Status checkKeepsOld(const Output& output);

/// Errors: io (the standard output is a terminal, which takes no file).
[[nodiscard]] Status checkNoTerminal();

/// Writes the file whole or not at all, or its pieces to the standard output. Errors:
/// checkKeepsOld's, for a file that appeared meanwhile; writeFileAtomically's; the content's.
[[nodiscard]] Status writeOutput(const Output& output, const ByteSource& content);
[[nodiscard]] Status writeOutput(const Output& output, ByteView bytes);

/// Prints what was written: to the standard output, or as notes where the file itself went there.
void reportOutput(const Output& output, const std::string& lines, Console& console);

}  // namespace qtet
