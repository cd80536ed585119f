// Which field a name means. Options, URLs, messages and the C library share this rule. It works on
// any list of things with a FieldName and an association. Each look-up walks the list; for many
// look-ups in one list there is field_keys.h.
#pragma once

#include <cstdint>
#include <optional>
#include <ranges>
#include <string_view>
#include <vector>

#include "proto/field_name.h"

namespace qtet {

/// Whether `key` is the name or "point:NAME" or "cell:NAME", as the association is.
[[nodiscard]] inline bool isCalled(std::string_view association, std::string_view name,
                                   std::string_view key) {
  return key == name ||
         (key.size() == association.size() + 1 + name.size() && key.starts_with(association) &&
          key[association.size()] == ':' && key.ends_with(name));
}

#ifndef NDEBUG
/// Names that this thread has compared with a key, so that tests can count the work of look-ups.
inline thread_local std::uint64_t namesCompared = 0;
#endif

/// The fields that `isMeant` is true of, ascending.
template <std::ranges::random_access_range Fields, class IsMeant>
[[nodiscard]] std::vector<std::uint32_t> fieldsThat(const Fields& fields, const IsMeant& isMeant) {
  std::vector<std::uint32_t> out;
#ifndef NDEBUG
  namesCompared += fields.size();
#endif
  for (std::uint32_t f = 0; f < fields.size(); ++f)
    if (isMeant(fields[f])) out.push_back(f);
  return out;
}

/// The fields of this name, ascending; without one, that of this name after "point:" or "cell:".
template <std::ranges::random_access_range Fields>
[[nodiscard]] std::vector<std::uint32_t> fieldsOfName(const Fields& fields, std::string_view key) {
  std::vector<std::uint32_t> out =
      fieldsThat(fields, [&](const auto& field) { return field.name == key; });
  if (!out.empty()) return out;
  return fieldsThat(
      fields, [&](const auto& field) { return isCalled(field.association, field.name, key); });
}

/// The fields that `key` means where it may mean several, ascending: fieldsOfName's, else every
/// step of a series, NAME@TIME.
template <std::ranges::random_access_range Fields>
[[nodiscard]] std::vector<std::uint32_t> fieldsOfKey(const Fields& fields, std::string_view key) {
  std::vector<std::uint32_t> out = fieldsOfName(fields, key);
  if (!out.empty()) return out;
  return fieldsThat(fields, [&](const auto& field) {
    return field.name.isInstant() && isCalled(field.association, field.name.withoutTime(), key);
  });
}

/// The one field that `key` means: the point field of that name, else the cell field of that name.
/// Else the field named after "point:" or "cell:". A step of a series needs its whole name.
template <std::ranges::random_access_range Fields>
[[nodiscard]] std::optional<std::uint32_t> fieldOfKey(const Fields& fields, std::string_view key) {
  std::optional<std::uint32_t> out;
  for (const std::uint32_t f : fieldsOfName(fields, key))
    if (!out || (fields[f].association == "point" && fields[*out].association != "point")) out = f;
  return out;
}

}  // namespace qtet
