// Series: fields that are the instants of one quantity, called NAME@TIME.
#pragma once

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <map>
#include <optional>
#include <ranges>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "proto/field_name.h"

namespace qtet {

/// A time that differs by less than this of the larger is the same one: decimal digits are lost.
inline constexpr double kNearTime = 1e-9;

[[nodiscard]] inline bool isSameTime(double a, double b) {
  return std::abs(a - b) <= kNearTime * std::max(std::abs(a), std::abs(b));
}

/// The number of the time nearest to `wanted`, of two the first. REQUIRES: one time at least.
[[nodiscard]] inline std::size_t nearestTime(std::span<const double> times, double wanted) {
  assert(!times.empty());
  const auto nearest = std::ranges::min_element(
      times, {}, [wanted](double time) { return std::abs(time - wanted); });
  return static_cast<std::size_t>(nearest - times.begin());
}

/// The number of the time that is meant: the exact one if it is there, else the nearest that is the
/// same (isSameTime). So times one apart stay apart, also where they are 1e9 and more.
[[nodiscard]] inline std::optional<std::size_t> placeOfTime(std::span<const double> times,
                                                            double wanted) {
  if (times.empty()) return std::nullopt;
  const std::size_t nearest = nearestTime(times, wanted);
  return isSameTime(times[nearest], wanted) ? std::optional(nearest) : std::nullopt;
}

struct Series {
  std::string name;
  std::string association;          ///< of its fields: point or cell
  std::vector<std::size_t> fields;  ///< numbers of the instants' fields, by time
  std::vector<double> times;        ///< ascending, as many
};

/// The series of `fewest` and more instants, in the order of their first fields. Instants agree in
/// association, components and type. Where two have one time, the first counts.
template <std::ranges::random_access_range Fields>
[[nodiscard]] std::vector<Series> seriesOf(const Fields& fields, std::size_t fewest = 2) {
  using Field = std::ranges::range_value_t<Fields>;
  std::vector<Series> out;
  std::map<std::tuple<std::string_view, decltype(Field::association), decltype(Field::components),
                      decltype(Field::type)>,
           std::size_t>
      places;
  for (std::size_t f = 0; f < fields.size(); ++f) {
    const Field& field = fields[f];
    const auto name = field.name.instant();
    if (!name) continue;
    const auto [place, isNew] = places.try_emplace(
        {name->series, field.association, field.components, field.type}, out.size());
    if (isNew) out.push_back({std::string(name->series), field.association, {}, {}});
    Series& series = out[place->second];
    const auto at = std::ranges::lower_bound(series.times, name->time);
    if (at != series.times.end() && *at == name->time) continue;
    series.fields.insert(series.fields.begin() + (at - series.times.begin()), f);
    series.times.insert(at, name->time);
  }
  std::erase_if(out, [&](const Series& series) { return series.fields.size() < fewest; });
  return out;
}

/// By field, of which there are `fields`: it is an instant of one of `all`, but not its series' one
/// of the lowest number. That one may be of any time; a viewer shows and fetches it first.
[[nodiscard]] inline std::vector<bool> laterInstants(std::span<const Series> all,
                                                     std::size_t fields) {
  std::vector<bool> out(fields);
  for (const Series& series : all) {
    assert(!series.fields.empty() && std::ranges::max(series.fields) < fields);
    for (const std::size_t f : series.fields) out[f] = true;
    out[*std::ranges::min_element(series.fields)] = false;
  }
  return out;
}

}  // namespace qtet
