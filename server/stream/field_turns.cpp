#include "server/stream/field_turns.h"

#include <algorithm>
#include <cassert>
#include <set>
#include <string_view>
#include <utility>

#include "proto/field_keys.h"
#include "proto/limits.h"
#include "proto/series.h"

namespace qtet {
namespace {

/// Adds the fields of the instants that are wished to a turn each.
void addInstants(const Series& series, const StreamTime& time, FieldTurns& turns) {
  assert(series.fields.size() == series.times.size());
  const std::size_t count = std::min<std::size_t>(time.ahead + 1, series.times.size());
  const std::size_t first = nearestTime(series.times, time.at);
  if (turns.size() < count) turns.resize(count);
  for (std::size_t i = 0; i < count; ++i)
    turns[i].push_back(
        static_cast<std::uint32_t>(series.fields[(first + i) % series.fields.size()]));
}

/// Gives each field its first turn alone, and with it those that it is predicted from. Ends before
/// the turn with which there would be more than kMaxRequestFields.
FieldTurns completed(const FieldTurns& turns, std::span<const FieldShape> shapes) {
  FieldTurns out;
  std::vector<bool> isTaken(shapes.size());
  std::size_t count = 0;
  for (const std::vector<std::uint32_t>& wanted : turns) {
    std::vector<std::uint32_t> turn = withParents(shapes, wanted);
    std::erase_if(turn, [&](std::uint32_t f) { return isTaken[f]; });
    count += turn.size();
    if (!out.empty() && count > kMaxRequestFields) break;
    if (!out.empty() && turn.empty()) continue;
    for (const std::uint32_t f : turn) isTaken[f] = true;
    out.push_back(std::move(turn));
  }
  return out;
}

FieldTurns inOneTurn(const FieldTurns& turns) {
  FieldTurns out(1);
  for (const std::vector<std::uint32_t>& turn : turns)
    out.front().insert(out.front().end(), turn.begin(), turn.end());
  std::ranges::sort(out.front());
  return out;
}

}  // namespace

std::expected<FieldTurns, std::string> fieldTurns(std::span<const std::string> names,
                                                  const std::optional<StreamTime>& time,
                                                  const FieldKeys& keys,
                                                  std::span<const Series> series,
                                                  std::span<const FieldShape> shapes) {
  assert(keys.size() == shapes.size());
  FieldTurns turns(1);
  std::set<std::string_view> known;
  std::set<std::uint32_t> taken;
  for (const std::string& name : names) {
    if (!known.insert(name).second) continue;
    if (const auto field = keys.fieldOfKey(name)) {
      turns.front().push_back(*field);
      continue;
    }
    const auto meant = time ? keys.seriesOfKey(name) : std::nullopt;
    if (!meant) return std::unexpected(name);
    assert(*meant < series.size());
    if (taken.insert(*meant).second) addInstants(series[*meant], *time, turns);
  }
  if (!time) {
    std::ranges::sort(turns.front());
    const auto twice = std::ranges::unique(turns.front());
    turns.front().erase(twice.begin(), twice.end());
    return turns;
  }
  turns = completed(turns, shapes);
  return time->first == StreamTime::First::kTime ? inOneTurn(turns) : turns;
}

}  // namespace qtet
