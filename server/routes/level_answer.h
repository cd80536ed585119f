// Shared by the addresses of levels, pictures and series: refusals, numbers, and the head of an
// answer that is made first.
#pragma once

#include <charconv>
#include <cstdint>
#include <expected>
#include <optional>
#include <string>
#include <string_view>

#include "server/routes/answer.h"
#include "server/wire/resource.h"

namespace qtet {

template <class T>
using OrRefusal = std::expected<T, Reply>;

[[nodiscard]] inline std::unexpected<Reply> badRequest(std::string_view detail) {
  return std::unexpected(badRequestReply(detail));
}
[[nodiscard]] inline std::unexpected<Reply> notFound(std::string_view detail) {
  return std::unexpected(missingReply(detail));
}

/// A whole text as a number; no sign for whole ones.
template <class T>
[[nodiscard]] std::optional<T> parseNumber(std::string_view text) {
  T out{};
  const auto [end, ec] = std::from_chars(text.data(), text.data() + text.size(), out);
  if (ec != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return out;
}
/// A level's or a chunk's number as every address writes it: no sign, no leading zero.
[[nodiscard]] std::optional<std::uint32_t> parseIndex(std::string_view text);
/// The same, neither infinite nor NaN.
[[nodiscard]] std::optional<double> parseFinite(std::string_view text);

/// Levels of the mesh, for a message: "the levels 0 to 12".
[[nodiscard]] std::string levelsText(const ServedMesh& mesh);

/// The request's bytes under its tag. The digest's own bytes decide, so the answer may be kept for
/// ever; the version of this program is part of the tag. A browser saves them as `name`, with the
/// form's ending, but shows pictures and JSON.
[[nodiscard]] Resource resourceOf(const LevelRequest& wanted, const std::string& name);
/// Chooses a coding of what is not compressed already, for the request and its resource.
void chooseCodingOf(LevelRequest& wanted, Resource& resource, const RequestView& request);
/// The head of a 200 and the work behind it, or 304 or 412.
[[nodiscard]] Answer toBeMade(const RequestView& request, const Resource& resource,
                              LevelRequest wanted);

}  // namespace qtet
