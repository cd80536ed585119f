#include "server/stream/field_turns.h"

#include <algorithm>
#include <cmath>

#include "proto/field_key.h"
#include "proto/manifest.h"
#include "proto/series.h"

namespace qtet {
namespace {

const Series* seriesOfKey(const std::vector<Series>& all, const Manifest& manifest,
                          const std::string& key) {
  const Series* out = nullptr;
  for (const Series& series : all) {
    const std::string& association = manifest.fields[series.fields.front()].association;
    if (!isCalled(association, series.name, key)) continue;
    if (out == nullptr || association == "point") out = &series;
    if (association == "point") break;
  }
  return out;
}

/// The fields of the instants that are wished, in the order in which they are.
std::vector<std::uint32_t> instantsOf(const Series& series, const StreamTime& time) {
  const auto nearest = std::ranges::min_element(
      series.times, {}, [&](double other) { return std::abs(other - time.at); });
  const auto first = static_cast<std::size_t>(nearest - series.times.begin());
  std::vector<std::uint32_t> out;
  for (std::size_t i = 0; i < std::min<std::size_t>(time.ahead + 1, series.times.size()); ++i)
    out.push_back(static_cast<std::uint32_t>(series.fields[(first + i) % series.times.size()]));
  return out;
}

/// Gives each field its first turn alone, and with it those that it is predicted from.
void complete(FieldTurns& turns, std::span<const FieldShape> shapes) {
  std::vector<bool> isTaken(shapes.size());
  for (std::vector<std::uint32_t>& turn : turns) {
    turn = withParents(shapes, turn);
    std::erase_if(turn, [&](std::uint32_t f) { return isTaken[f]; });
    for (const std::uint32_t f : turn) isTaken[f] = true;
  }
  const auto [first, last] =
      std::ranges::remove_if(turns.begin() + 1, turns.end(), &std::vector<std::uint32_t>::empty);
  turns.erase(first, last);
}

}  // namespace

std::expected<FieldTurns, std::string> fieldTurns(std::span<const std::string> names,
                                                  const std::optional<StreamTime>& time,
                                                  const Manifest& manifest,
                                                  std::span<const FieldShape> shapes) {
  FieldTurns turns(1);
  const std::vector<Series> all =
      time ? seriesOf(std::span(manifest.fields)) : std::vector<Series>{};
  std::vector<const Series*> taken;  // else a name a thousand times would take long
  for (const std::string& name : names) {
    if (const auto field = fieldOfKey(manifest, name)) {
      turns.front().push_back(*field);
      continue;
    }
    const Series* series = seriesOfKey(all, manifest, name);
    if (series == nullptr) return std::unexpected(name);
    if (std::ranges::find(taken, series) != taken.end()) continue;
    taken.push_back(series);
    const std::vector<std::uint32_t> instants = instantsOf(*series, *time);
    const bool inTurns = time->first == StreamTime::First::kSpace;
    if (inTurns && turns.size() < instants.size()) turns.resize(instants.size());
    for (std::size_t i = 0; i < instants.size(); ++i) turns[inTurns ? i : 0].push_back(instants[i]);
  }
  for (std::vector<std::uint32_t>& turn : turns) {
    std::ranges::sort(turn);
    const auto twice = std::ranges::unique(turn);
    turn.erase(twice.begin(), twice.end());
  }
  if (time) complete(turns, shapes);
  return turns;
}

}  // namespace qtet
