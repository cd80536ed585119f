// The words about known error that commands share: --measure and its bounds, and NAME=E.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "proto/manifest.h"
#include "simplify/measure/measure_error.h"
#include "simplify/words/json_report.h"
#include "simplify/words/parsed_words.h"

namespace qtet {

/// A name and a number of 0 or above from "NAME=E"; the last '=' counts. `meaning` tells what to
/// write instead. Throws UsageError.
[[nodiscard]] std::pair<std::string, double> parseNamedNumber(const std::string& option,
                                                              const std::string& text,
                                                              const std::string& meaning);
/// The same for a field's name and a fraction of its range.
[[nodiscard]] std::pair<std::string, double> parseNamedError(const std::string& option,
                                                             const std::string& text);

void addMeasureOptions(po::options_description& options);
/// nullopt for `--measure none`. Throws UsageError, also where a bound is to be kept without
/// measuring.
[[nodiscard]] std::optional<MeasureOptions> measureOptionsOf(const ParsedWords& parsed);

/// {measure, base}: the word given and the error of the base mesh, where it was measured.
[[nodiscard]] OrderedJson measureReport(const std::optional<MeasureOptions>& options,
                                        const Manifest& manifest);
/// The shape's figures of measureReport in a line for people; empty where nothing was measured.
[[nodiscard]] std::string measureSentence(const OrderedJson& report);

/// "rms 0.012 %", or of a label "12 % of the volume wrong": of a field's error as JSON.
[[nodiscard]] std::string fieldErrorText(const OrderedJson& error);

/// "0.012 %": a fraction for people, three significant digits.
[[nodiscard]] std::string percentText(double fraction);

}  // namespace qtet
