#include "proto/field_keys.h"

#include <algorithm>
#include <cassert>
#include <functional>
#include <iterator>
#include <map>
#include <set>
#include <tuple>
#include <utility>

namespace qtet {
namespace {

constexpr std::string_view kPoint = "point";

std::strong_ordering compared(std::string_view a, std::string_view b) {
#ifndef NDEBUG
  ++namesCompared;
#endif
  return a <=> b;
}

}  // namespace

std::strong_ordering NamesInOrder::Entry::operator<=>(const Entry& other) const {
  if (const auto names = compared(name, other.name); names != 0) return names;
  return std::tie(association, number) <=> std::tie(other.association, other.number);
}

void NamesInOrder::add(std::string_view name, std::string_view association, std::uint32_t number) {
  entries_.push_back({name, association, number});
  if (std::ranges::find(associations_, association) == associations_.end())
    associations_.push_back(association);
}

void NamesInOrder::sort() { std::ranges::sort(entries_, std::less()); }

std::span<const NamesInOrder::Entry> NamesInOrder::entriesOf(std::string_view name) const {
  const auto isBefore = [](const Entry& entry, std::string_view other) {
    return compared(entry.name, other) < 0;
  };
  const auto isBehind = [](std::string_view other, const Entry& entry) {
    return compared(other, entry.name) < 0;
  };
  const auto first = std::lower_bound(entries_.begin(), entries_.end(), name, isBefore);
  return {first, std::upper_bound(first, entries_.end(), name, isBehind)};
}

std::span<const NamesInOrder::Entry> NamesInOrder::entriesOf(std::string_view name,
                                                             std::string_view association) const {
  return std::ranges::equal_range(entriesOf(name), association, {}, &Entry::association);
}

std::vector<std::uint32_t> NamesInOrder::named(std::string_view name) const {
  std::vector<std::uint32_t> out;
  for (const Entry& entry : entriesOf(name)) out.push_back(entry.number);
  std::ranges::sort(out);
  return out;
}

std::vector<std::uint32_t> NamesInOrder::qualified(std::string_view key) const {
  std::vector<std::uint32_t> out;
  for (const std::string_view association : associations_) {
    if (!key.starts_with(association) || key.size() == association.size() ||
        key[association.size()] != ':')
      continue;
    for (const Entry& entry : entriesOf(key.substr(association.size() + 1), association))
      out.push_back(entry.number);
  }
  std::ranges::sort(out);
  return out;
}

std::vector<std::uint32_t> NamesInOrder::called(std::string_view key) const {
  std::vector<std::uint32_t> out;
  std::ranges::merge(named(key), qualified(key), std::back_inserter(out));
  return out;
}

std::optional<std::uint32_t> NamesInOrder::firstNamed(std::string_view name) const {
  if (const auto points = entriesOf(name, kPoint); !points.empty()) return points.front().number;
  std::optional<std::uint32_t> out;
  for (const std::string_view association : associations_)
    if (const auto found = entriesOf(name, association); !found.empty())
      out = std::min(out.value_or(found.front().number), found.front().number);
  return out;
}

void FieldKeys::add(const Named& field) {
  const auto number = static_cast<std::uint32_t>(fields_.size());
  fields_.push_back(field);
  names_.add(field.name, field.association, number);
  if (field.instant) instants_.add(field.instant->series, field.association, number);
}

void FieldKeys::addSeries(const Named& series) {
  series_.add(series.name, series.association, static_cast<std::uint32_t>(allSeries_.size()));
  allSeries_.push_back(series);
}

void FieldKeys::sort() {
  names_.sort();
  instants_.sort();
  series_.sort();
}

std::optional<std::uint32_t> FieldKeys::pointsFirst(std::span<const std::uint32_t> numbers,
                                                    std::span<const Named> all) {
  if (numbers.empty()) return std::nullopt;
  const auto found = std::ranges::find_if(
      numbers, [&](std::uint32_t number) { return all[number].association == kPoint; });
  return found == numbers.end() ? numbers.front() : *found;
}

std::vector<std::uint32_t> FieldKeys::fieldsOfName(std::string_view key) const {
  std::vector<std::uint32_t> out = names_.named(key);
  return out.empty() ? names_.qualified(key) : out;
}

std::vector<std::uint32_t> FieldKeys::fieldsOfKey(std::string_view key) const {
  std::vector<std::uint32_t> out = fieldsOfName(key);
  return out.empty() ? instants_.called(key) : out;
}

std::optional<std::uint32_t> FieldKeys::fieldOfKey(std::string_view key) const {
  const auto named = names_.firstNamed(key);
  return named ? named : pointsFirst(names_.qualified(key), fields_);
}

std::optional<std::uint32_t> FieldKeys::seriesOfKey(std::string_view key) const {
  return pointsFirst(series_.called(key), allSeries_);
}

std::string FieldKeys::keyOf(std::size_t f) const {
  assert(f < fields_.size());
  const auto& [name, association, instant] = fields_[f];
  return names_.firstNamed(name) == f ? std::string(name)
                                      : std::string(association) + ":" + std::string(name);
}

std::vector<ListedKey> FieldKeys::listed() const {
  std::map<std::pair<std::string_view, std::string_view>, std::size_t> instants;
  const auto groupOf = [](std::string_view series, std::string_view association) {
    return std::pair(series, association);
  };
  for (const auto& [name, association, instant] : fields_)
    if (instant) ++instants[groupOf(instant->series, association)];
  std::vector<ListedKey> out;
  std::set<std::string> known;
  for (std::size_t f = 0; f < fields_.size(); ++f) {
    const auto& [name, association, instant] = fields_[f];
    ListedKey item{keyOf(f)};
    if (instant && instants.at(groupOf(instant->series, association)) > 1) {
      const std::string_view series = instant->series;
      const bool isMeant = association == kPoint || !instants.contains(groupOf(series, kPoint));
      std::string ofSeries = (isMeant ? "" : std::string(association) + ":") + std::string(series);
      if (fieldsOfName(ofSeries).empty()) item = {std::move(ofSeries), true};
    }
    if (known.insert(item.key).second) out.push_back(std::move(item));
  }
  return out;
}

}  // namespace qtet
