// The words of --fields.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace qtet {

/// The help of every option --fields of a mesh or a log (proto/field_key.h).
inline constexpr const char* kFieldsHelp =
    "all, none, or names between commas: NAME means every field of that name, of a series (--time "
    "all) every step's, NAME@TIME; point:NAME or cell:NAME is one of two with the same name; \\, "
    "is a comma in a name";

/// The names between commas, of which "\\," is one in a name, and "\\\\" a backslash before it;
/// "all" is nullopt, "none" the empty list. Throws UsageError.
[[nodiscard]] std::optional<std::vector<std::string>> parseFieldNames(const std::string& text);

}  // namespace qtet
