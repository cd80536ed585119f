// Tables for people.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace qtet {

/// The widest line of a table: terminals and mails have room for it.
inline constexpr std::size_t kLineColumns = 100;
/// A log may have 8,192 fields; a page has room for so many.
inline constexpr std::size_t kShownFields = 10;

/// A line a row, whose columns are as wide as their widest cell. The first column stands at the
/// left, the others at the right.
[[nodiscard]] std::string columns(const std::vector<std::vector<std::string>>& rows);

/// "and 93 more fields\n", with what shows them behind a colon; empty if all are shown.
[[nodiscard]] std::string moreFields(std::size_t all, const std::string& how);

}  // namespace qtet
