// Where a command writes, and how it ends.
#pragma once

#include <cstddef>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include "simplify/words/option_names.h"
#include "simplify/words/printable.h"

namespace qtet {

/// Exit codes of the process.
inline constexpr int kExitOk = 0;
inline constexpr int kExitFailed = 1;  ///< an input, a file or the machine is at fault
inline constexpr int kExitUsage = 2;   ///< the words given are not understood

/// Where a command writes: results to `out`, everything else to `err`, each line of it starting
/// with "qtet: ".
struct Console {
  std::ostream& out;
  std::ostream& err;
  bool errIsTerminal = false;
  /// Whether `out` may be coloured: a terminal, and NO_COLOR is not set (https://no-color.org).
  bool colours = false;
  bool quiet = false;    ///< --quiet: errors and warnings alone
  bool verbose = false;  ///< --verbose: how long each stage takes, and the memory at most
  std::string piped{};   ///< the temporary file that holds the standard input, where a word was "-"

  /// The text with options for members of the library. A file that came through a pipe is called
  /// so, and not by its temporary name.
  [[nodiscard]] std::string named(std::string text) const {
    for (std::size_t at = 0; !piped.empty() && (at = text.find(piped)) != std::string::npos;)
      text.replace(at, piped.size(), "the standard input");
    return withOptionNames(std::move(text));
  }
  /// named() for a terminal.
  [[nodiscard]] std::string shown(const std::string& text, bool keepLines = false) const {
    return printable(named(text), keepLines);
  }
  void note(const std::string& text) const {
    if (!quiet) err << "qtet: note: " << shown(text) << "\n";
  }
  /// Warns that the result, made as asked, is most probably not what was wanted; also with --quiet.
  void warn(const std::string& text) const { err << "qtet: warning: " << shown(text) << "\n"; }
};

using Words = std::vector<std::string>;

}  // namespace qtet
