#include "simplify/commands/extract_choice.h"

#include <algorithm>
#include <cassert>
#include <functional>
#include <limits>
#include <string>
#include <utility>

#include "codec/log/target_choice.h"
#include "proto/field_key.h"
#include "proto/series.h"
#include "simplify/log/opened_list.h"
#include "simplify/words/measure_words.h"

namespace qtet {
namespace {

Target targetOf(const ParsedWords& parsed, const Manifest& manifest) {
  const auto cells = [](double most) { return TetrahedraTarget{static_cast<std::uint64_t>(most)}; };
  if (parsed.has("error")) {
    auto [field, error] = parseNamedError("error", parsed.get<std::string>("error"));
    return FieldErrorTarget{error, std::move(field)};
  }
  if (parsed.has("boundary-error"))
    return BoundaryErrorTarget{parsed.number("boundary-error", 0, 1)};
  if (parsed.has("tets")) return cells(parsed.number("tets", 0, 1e18));
  assert(parsed.has("ratio"));
  return cells(parsed.number("ratio", 0, 1) * manifest.levels.back().tetrahedra);
}

/// The fields of a segment that NAME of `--error` means at these times: those of points if there
/// are some, and also those without time. Throws UsageError where NAME has a time.
std::vector<std::uint32_t> fieldsAt(const Manifest& manifest, const std::string& name,
                                    const std::vector<double>& times) {
  if (FieldName(name).isInstant())
    throw UsageError("--error " + name +
                     " has a time; for a list give the field's name alone, and --time T");
  const std::vector<double> instants = instantTimes(manifest);
  std::vector<std::uint32_t> out = fieldsOfKey(manifest.fields, name);
  std::erase_if(out, [&](std::uint32_t f) {
    const auto instant = manifest.fields[f].name.instant();
    return instant && std::ranges::none_of(times, [&](double time) {
             const auto place = placeOfTime(instants, time);
             return place && instants[*place] == instant->time;
           });
  });
  const auto isOfPoints = [&](std::uint32_t f) {
    return manifest.fields[f].association == "point";
  };
  if (std::ranges::any_of(out, isOfPoints)) std::erase_if(out, std::not_fn(isOfPoints));
  return out;
}

}  // namespace

Result<std::uint32_t> chosenLevel(const ParsedWords& parsed, const OpenedLog& log) {
  if (parsed.has("level"))
    return static_cast<std::uint32_t>(parsed.integer("level", 0, std::numeric_limits<int>::max()));
  return levelFor(targetOf(parsed, log.manifest), log.manifest, log.file.index());
}

Result<std::uint32_t> levelOfSegment(const ParsedWords& parsed, const OpenedLog& log,
                                     const std::vector<double>& times) {
  if (!parsed.has("error")) return chosenLevel(parsed, log);
  const auto [name, error] = parseNamedError("error", parsed.get<std::string>("error"));
  const std::vector<std::uint32_t> fields = fieldsAt(log.manifest, name, times);
  if (fields.empty()) return std::unexpected(noSuchField(log.manifest, name));
  return levelOfFieldErrors(error, fields, log.manifest);
}

}  // namespace qtet
