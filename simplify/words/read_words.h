// The options of every command that reads a mesh.
#pragma once

#include <boost/program_options.hpp>

#include "simplify/clean/clean_mesh.h"
#include "simplify/read/options/read_options.h"
#include "simplify/words/json_report.h"
#include "simplify/words/parsed_words.h"

namespace qtet {

/// --curved, --weld, --time, --threshold, --plot3d, --read-seconds, --format.
/// `time` is what --time means where it is not given.
void addReadOptions(po::options_description& options, const char* time = "last");

/// --times: numbers between commas; none where it is not given. Throws UsageError.
[[nodiscard]] std::vector<double> timesOf(const ParsedWords& parsed);

/// --times of a series of numbered files.
void addTimesOption(po::options_description& options);

/// The input that the words of "IN..." name, for reading and for reports. Several files are set in
/// `options.listed`, and so is --times.
[[nodiscard]] std::string inputOf(const ParsedWords& parsed, ReadOptions& options);

/// The words that say the same once more, for another command.
[[nodiscard]] Words readWordsOf(const ParsedWords& parsed);

/// The reading options that the words ask for; the fields stay to be set. Throws UsageError.
[[nodiscard]] ReadOptions readOptionsOf(const ParsedWords& parsed);

/// How many cells of which kind were split, points welded and so on.
[[nodiscard]] OrderedJson readReport(const ReadReport& report);

/// Shows at once whether a mesh was read right: {volume, box, invertedCells, components}.
[[nodiscard]] OrderedJson soundnessReport(const CleanReport& clean);

/// "volume 1, box 0 0 0 to 1 1 1, no inverted cell, 1 part", of soundnessReport's members.
[[nodiscard]] std::string soundnessText(const OrderedJson& mesh);

}  // namespace qtet
