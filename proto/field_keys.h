// The rules of field_key.h for many fields: names are looked up instead of searched for.
#pragma once

#include <compare>
#include <cstdint>
#include <optional>
#include <ranges>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "proto/field_key.h"
#include "proto/series.h"

namespace qtet {

/// Numbers of things that have a name and an association, in order.
class NamesInOrder {
 public:
  /// Both texts outlive the object.
  void add(std::string_view name, std::string_view association, std::uint32_t number);
  /// After the last add().
  void sort();

  /// Those of exactly this name, ascending.
  [[nodiscard]] std::vector<std::uint32_t> named(std::string_view name) const;
  /// Those that are called "ASSOCIATION:NAME", ascending.
  [[nodiscard]] std::vector<std::uint32_t> qualified(std::string_view key) const;
  /// Those of either kind (isCalled), ascending.
  [[nodiscard]] std::vector<std::uint32_t> called(std::string_view key) const;
  /// Among those of exactly this name, the first of points, else the first.
  [[nodiscard]] std::optional<std::uint32_t> firstNamed(std::string_view name) const;

 private:
  struct Entry {
    std::string_view name, association;
    std::uint32_t number = 0;

    [[nodiscard]] std::strong_ordering operator<=>(const Entry& other) const;
  };
  [[nodiscard]] std::span<const Entry> entriesOf(std::string_view name) const;
  [[nodiscard]] std::span<const Entry> entriesOf(std::string_view name,
                                                 std::string_view association) const;

  std::vector<Entry> entries_;
  std::vector<std::string_view> associations_;  // each once
};

/// An item of a list of fields.
struct ListedKey {
  std::string key;
  bool isSeries = false;  ///< it stands for several instants

  [[nodiscard]] bool operator==(const ListedKey&) const = default;
};

/// Made once for all look-ups: n log n comparisons. Then each costs log n, and what it returns.
/// Immutable, so thread-safe.
class FieldKeys {
 public:
  /// The fields, and `series` (of them, series.h), outlive the object and stay where they are.
  template <std::ranges::random_access_range Fields>
  explicit FieldKeys(const Fields& fields, std::span<const Series> series = {}) {
    for (const auto& field : fields) add({field.name, field.association, field.name.instant()});
    for (const Series& one : series) addSeries({one.name, one.association, {}});
    sort();
  }

  [[nodiscard]] std::size_t size() const { return fields_.size(); }
  /// As fieldOfKey, fieldsOfName and fieldsOfKey of field_key.h.
  [[nodiscard]] std::optional<std::uint32_t> fieldOfKey(std::string_view key) const;
  [[nodiscard]] std::vector<std::uint32_t> fieldsOfName(std::string_view key) const;
  [[nodiscard]] std::vector<std::uint32_t> fieldsOfKey(std::string_view key) const;
  /// The number of the series that `key` means: of points before of cells. "cell:NAME" means one of
  /// cells.
  [[nodiscard]] std::optional<std::uint32_t> seriesOfKey(std::string_view key) const;
  /// The key of field f, as fieldKey (manifest.h). REQUIRES: such a field.
  [[nodiscard]] std::string keyOf(std::size_t f) const;

  /// The keys of a list. Instants of one series (T@0 and T@1) have one, T, where the first of them
  /// stands. Instants of cells have "cell:T" if there are those of points. Where the key means
  /// another field, instants have their own.
  [[nodiscard]] std::vector<ListedKey> listed() const;

 private:
  struct Named {
    std::string_view name, association;
    std::optional<InstantName> instant;
  };
  void add(const Named& field);
  void addSeries(const Named& series);
  void sort();
  /// The first of points among these numbers of `all`, else the first.
  [[nodiscard]] static std::optional<std::uint32_t> pointsFirst(
      std::span<const std::uint32_t> numbers, std::span<const Named> all);

  std::vector<Named> fields_, allSeries_;  // by number
  NamesInOrder names_, instants_, series_;
};

}  // namespace qtet
