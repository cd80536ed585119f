#include "simplify/words/measure_words.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <sstream>

#include "proto/level_error_json.h"

namespace qtet {

std::pair<std::string, double> parseNamedNumber(const std::string& option, const std::string& text,
                                                const std::string& meaning) {
  const std::size_t equals = text.rfind('=');
  const auto refuse = [&](const std::string& what) -> UsageError {
    return UsageError("--" + option + " '" + text + "' " + what + "; write " + meaning);
  };
  if (equals == std::string::npos || equals == 0) throw refuse("names no field");
  double error = 0;
  const char* end = text.data() + text.size();
  const auto read = std::from_chars(text.data() + equals + 1, end, error);
  if (read.ec != std::errc() || read.ptr != end || !std::isfinite(error) || error < 0)
    throw refuse("has no number of 0 or above");
  return {text.substr(0, equals), error};
}

std::pair<std::string, double> parseNamedError(const std::string& option, const std::string& text) {
  return parseNamedNumber(
      option, text, "NAME=E, a field's name and a fraction of its range such as Density=0.01");
}

void addMeasureOptions(po::options_description& options) {
  options.add_options()(
      "measure", po::value<std::string>()->default_value("levels"),
      "the known errors in the log's manifest: none, levels (about a dozen of "
      "them; a quarter to two thirds of the time of simplifying, on parts of "
      "many faces as much), or all (every level, by 200,000 samples of the volume and "
      "of each boundary)")(
      "base-error", po::value<double>(),
      "the base mesh is the coarsest level whose boundary is within this fraction of the diagonal "
      "and whose volume and fields are within twice this fraction, fields up to 24 kB; 0.01 "
      "without, and 30,000 tetrahedra or 64 kB at most")(
      "max-boundary-error", po::value<double>(),
      "stop before the boundary is further than this from the original's, either way, as a "
      "fraction of the diagonal")(
      "max-field-error", po::value<std::vector<std::string>>(),
      "NAME=E: stop before the field's rms error over the volume passes E, a fraction of its "
      "range, or of a label's volume that is wrong; may be given for several fields");
}

std::optional<MeasureOptions> measureOptionsOf(const ParsedWords& parsed) {
  const auto word = parsed.get<std::string>("measure");
  if (word != "none" && word != "levels" && word != "all")
    throw UsageError("--measure '" + word + "' is none of none, levels, all");
  MeasureOptions options;
  options.effort = word == "all" ? Effort::kAll : Effort::kLevels;
  if (parsed.has("max-boundary-error"))
    options.bounds.boundary = parsed.number("max-boundary-error", 0, 1);
  if (parsed.has("base-error")) options.base = {.error = parsed.number("base-error", 0, 1)};
  if (parsed.has("max-field-error"))
    for (const std::string& text : parsed.get<std::vector<std::string>>("max-field-error"))
      options.bounds.fields.push_back(parseNamedError("max-field-error", text));
  if (word != "none") return options;
  if (options.bounds.any() || options.base)
    throw UsageError("an error bound needs measuring; leave out --measure none");
  return std::nullopt;
}

OrderedJson measureReport(const std::optional<MeasureOptions>& options, const Manifest& manifest) {
  OrderedJson out = {{"measure", !options                          ? "none"
                                 : options->effort == Effort::kAll ? "all"
                                                                   : "levels"}};
  if (const auto& base = manifest.levels.front().error)
    out["base"] = toJson(*base, labelsAmong(manifest));
  return out;
}

std::string percentText(double fraction) {
  std::ostringstream out;
  out.precision(3);
  out << 100 * fraction << " %";
  return out.str();
}

std::string fieldErrorText(const OrderedJson& error) {
  if (const auto wrong = error.find("wrong"); wrong != error.end())
    return percentText(wrong->get<double>()) + " of the volume wrong";
  return "rms " + percentText(error["rms"].get<double>());
}

std::string measureSentence(const OrderedJson& report) {
  if (!report.contains("base")) return {};
  const OrderedJson& base = report["base"];
  const auto farthest = [&](const char* way) { return base["boundary"][way]["max"].get<double>(); };
  return "base mesh: boundary within " +
         percentText(std::max(farthest("toLevel"), farthest("toOriginal"))) + " of the diagonal, " +
         percentText(base["volumeLost"].get<double>()) + " of the volume lost, " +
         percentText(base["volumeGained"].get<double>()) + " gained";
}

}  // namespace qtet
