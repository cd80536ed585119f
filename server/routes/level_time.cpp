#include "server/routes/level_time.h"

#include <algorithm>
#include <vector>

#include "proto/instants.h"
#include "proto/number_text.h"
#include "proto/series.h"

namespace qtet {
namespace {

/// Times that a refusal names.
constexpr std::size_t kShownTimes = 12;

std::string shownTimes(const std::vector<double>& times) {
  std::string out;
  for (std::size_t i = 0; i < std::min(times.size(), kShownTimes); ++i)
    out += (i == 0 ? "" : ", ") + shortestText(times[i]);
  return out + (times.size() > kShownTimes ? ", ..." : "");
}

/// nullopt: the log has no instants, and any will do.
OrRefusal<std::optional<double>> chosenTime(const std::vector<double>& times,
                                            const std::string& asked) {
  const bool isWord = asked == "first" || asked == "last";
  const std::optional<double> number = parseFinite(asked);
  if (!isWord && !number)
    return badRequest("time is a number, first or last, like time=0.5; a level has one instant");
  if (times.empty() && isWord) return std::nullopt;
  if (times.empty())
    return notFound("these fields have no instant " + asked +
                    ", for none of them is a series; leave out time");
  if (isWord) return asked == "first" ? times.front() : times.back();
  const auto found = placeOfTime(times, *number);
  if (!found)
    return notFound("these fields have no instant " + asked + "; they have " + shownTimes(times) +
                    "; give time one of them, first or last");
  return times[*found];
}

}  // namespace

OrRefusal<LevelRequest> atTime(LevelRequest wanted, const std::string& asked) {
  const Manifest& manifest = wanted.mesh->manifest;
  const Instants instants(manifest.fields, wanted.fields, manifest.series);
  const OrRefusal<std::optional<double>> time = chosenTime(instants.times(), asked);
  if (!time) return std::unexpected(time.error());
  const InstantFile file = instants.fileAt(*time);
  std::vector<std::uint32_t> fields;
  for (const FieldInFile& field : file.fields) {
    fields.push_back(field.number);
    wanted.names.push_back(field.name);
  }
  wanted.fields = std::move(fields);
  return wanted;
}

}  // namespace qtet
