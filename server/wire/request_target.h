// The request target, taken apart: path segments decoded one by one, so that an encoded slash never
// becomes a separator.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace qtet {

struct RequestTarget {
  /// "/v1/meshes" is {"v1", "meshes"}, "/" is {""}, "/a/" is {"a", ""}.
  std::vector<std::string> segments;
  std::string query;  ///< as it stands, without the ?

  /// The decoded value of the first query parameter of that name; a + in it is a space. nullopt:
  /// there is none, or a percent code in it is broken.
  [[nodiscard]] std::optional<std::string> parameter(std::string_view name) const;
  /// The decoded name of a query parameter that is given twice; nullopt: there is none.
  [[nodiscard]] std::optional<std::string> repeatedParameter() const;
};

/// Reads origin-form ("/path?query") and http absolute-form targets. nullopt: anything else, a
/// broken percent code, control bytes, bytes above 126 that are not percent-encoded, a fragment, or
/// an encoded NUL.
[[nodiscard]] std::optional<RequestTarget> parseTarget(std::string_view target);

/// Encodes everything but RFC 3986's unreserved characters: one path segment.
[[nodiscard]] std::string percentEncode(std::string_view text);

}  // namespace qtet
