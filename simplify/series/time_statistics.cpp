#include "simplify/series/time_statistics.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

#include "proto/field_name.h"
#include "proto/limits.h"
#include "proto/series.h"

namespace qtet {
namespace {

constexpr std::array<std::string_view, 4> kSuffixes{"_average", "_minimum", "_maximum", "_stddev"};

/// The series' name of an instant, and the name of any other field.
std::string_view shownName(const MeshField& field) { return field.name.withoutTime(); }

Status checkName(const std::string& name, const std::string& association,
                 std::span<const MeshField> fields) {
  if (name.size() > kMaxNameBytes)
    return fail(ErrorCode::kLimitExceeded, "`timeStatistics` would make a field whose name has " +
                                               std::to_string(name.size()) + " bytes, " + name +
                                               "; a name has at most " +
                                               std::to_string(kMaxNameBytes));
  const auto isTaken = [&](const MeshField& field) {
    return field.association == association && (shownName(field) == name || field.name == name);
  };
  if (std::ranges::none_of(fields, isTaken)) return {};
  return fail(ErrorCode::kBadValue, "`timeStatistics` would make the " + association + " field " +
                                        name +
                                        ", which the input has already; choose the others with "
                                        "`fields`, or leave out `timeStatistics`");
}

/// A number that the type holds.
double inType(double value, const std::string& type) {
  return type == "float32" ? static_cast<double>(static_cast<float>(value)) : value;
}

}  // namespace

std::vector<std::string> statisticsNames(std::string_view series) {
  std::vector<std::string> out;
  for (const std::string_view suffix : kSuffixes)
    out.push_back(std::string(series) + std::string(suffix));
  return out;
}

Status checkTimeStatistics(std::span<const MeshField> fields, std::size_t count) {
  const std::vector<Series> all = seriesOf(fields);
  if (all.empty())
    return fail(ErrorCode::kBadValue,
                "`timeStatistics` needs a series, fields NAME@TIME of two times or more, as `time` "
                "all makes them; there is none");
  if (const std::size_t more = kSuffixes.size() * all.size(); count + more > kMaxFields)
    return fail(ErrorCode::kLimitExceeded, "`timeStatistics` makes " + std::to_string(more) +
                                               " fields beside " + std::to_string(count) +
                                               ", and a log holds " + std::to_string(kMaxFields) +
                                               "; choose fewer with `fields` or `time`");
  for (std::size_t s = 0; s < all.size(); ++s) {
    const std::string& association = fields[all[s].fields[0]].association;
    for (std::size_t other = 0; other < s; ++other)
      if (all[other].name == all[s].name && fields[all[other].fields[0]].association == association)
        return fail(ErrorCode::kBadValue,
                    "`timeStatistics`: the " + association + " field " + all[s].name +
                        " changes its type or components over time, so that it is two series; "
                        "choose one with `fields`, or leave out `timeStatistics`");
    for (const std::string& name : statisticsNames(all[s].name))
      if (Status checked = checkName(name, association, fields); !checked) return checked;
  }
  return {};
}

Status TimeStatistics::add(std::span<const MeshField> fields) {
  std::vector<std::pair<double, std::size_t>> byTime;
  for (std::size_t f = 0; f < fields.size(); ++f)
    if (const auto name = fields[f].name.instant()) byTime.emplace_back(name->time, f);
  std::ranges::sort(byTime);
  for (const auto& [time, f] : byTime)
    if (Status added = addInstant(fields[f]); !added) return added;
  return {};
}

Status TimeStatistics::addInstant(const MeshField& field) {
  assert(field.name.isInstant());
  const InstantName name = *field.name.instant();
  auto sums = std::ranges::find_if(series_, [&](const Sums& known) {
    return known.kind.name == name.series && known.kind.association == field.association &&
           known.kind.components == field.components && known.kind.type == field.type;
  });
  const std::size_t values = field.values.size();
  if (sums == series_.end()) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    series_.push_back(
        {{std::string(name.series), field.components, field.type, {}, field.association},
         -kInfinity,
         0,
         std::vector<std::uint32_t>(values),
         std::vector<double>(values),
         std::vector<double>(values),
         std::vector<double>(values, kInfinity),
         std::vector<double>(values, -kInfinity)});
    sums = std::prev(series_.end());
  }
  if (values != sums->counts.size())
    return fail(ErrorCode::kBadInput, field.name + " has " + std::to_string(values) +
                                          " values, the instants before it " +
                                          std::to_string(sums->counts.size()));
  if (name.time <= sums->lastTime) return {};
  sums->lastTime = name.time;
  ++sums->instants;
  for (std::size_t i = 0; i < values; ++i) {
    const double value = field.values[i];
    if (!std::isfinite(value)) continue;
    const double off = value - sums->means[i];
    sums->means[i] += off / ++sums->counts[i];
    sums->squares[i] += off * (value - sums->means[i]);
    sums->least[i] = std::min(sums->least[i], value);
    sums->largest[i] = std::max(sums->largest[i], value);
  }
  return {};
}

std::vector<MeshField> TimeStatistics::fieldsOf(Sums&& given) {
  assert(given.means.size() == given.counts.size() && given.least.size() == given.counts.size());
  Sums sums = std::move(given);
  const std::string& type = sums.kind.type;
  const std::string floats = isFloatType(type) ? type : "float64";
  constexpr double kNoValue = std::numeric_limits<double>::quiet_NaN();
  for (std::size_t i = 0; i < sums.counts.size(); ++i) {
    double &mean = sums.means[i], &square = sums.squares[i];
    if (sums.counts[i] == 0) {
      mean = square = sums.least[i] = sums.largest[i] = kNoValue;
      continue;
    }
    assert(sums.least[i] <= sums.largest[i] && sums.counts[i] <= sums.instants);
    // rounding may leave the mean outside of the values
    mean = inType(std::clamp(mean, sums.least[i], sums.largest[i]), floats);
    square = inType(std::sqrt(square / sums.counts[i]), floats);
  }
  const std::vector<std::string> names = statisticsNames(sums.kind.name);
  const auto field = [&](std::size_t which, const std::string& of, std::vector<double>&& values) {
    return MeshField{names[which], sums.kind.components, of, std::move(values),
                     sums.kind.association};
  };
  std::vector<MeshField> out;
  out.push_back(field(0, floats, std::move(sums.means)));
  out.push_back(field(1, type, std::move(sums.least)));
  out.push_back(field(2, type, std::move(sums.largest)));
  out.push_back(field(3, floats, std::move(sums.squares)));
  return out;
}

std::vector<MeshField> TimeStatistics::take() {
  std::vector<MeshField> out;
  for (Sums& sums : series_)
    if (sums.instants > 1) std::ranges::move(fieldsOf(std::move(sums)), std::back_inserter(out));
  return out;
}

Status addTimeStatistics(std::vector<MeshField>& fields) {
  if (Status checked = checkTimeStatistics(fields, fields.size()); !checked) return checked;
  TimeStatistics statistics;
  if (Status added = statistics.add(fields); !added) return added;
  std::ranges::move(statistics.take(), std::back_inserter(fields));
  return {};
}

}  // namespace qtet
