// The options of every command that reads a mesh.
#pragma once

#include <boost/program_options.hpp>

#include "simplify/commands/command_line.h"
#include "simplify/read/options/read_options.h"

namespace qtet {

/// --curved, --weld, --time, --threshold, --plot3d, --read-seconds, --format.
/// `time` is what --time means where it is not given.
void addReadOptions(boost::program_options::options_description& options,
                    const char* time = "last");

/// The words that say the same once more, for another command.
[[nodiscard]] Words readWordsOf(const ParsedWords& parsed);

/// The reading options that the words ask for; the fields stay to be set. Throws UsageError.
[[nodiscard]] ReadOptions readOptionsOf(const ParsedWords& parsed);

/// How many cells of which kind were split, points welded and so on.
[[nodiscard]] OrderedJson readReport(const ReadReport& report);

}  // namespace qtet
