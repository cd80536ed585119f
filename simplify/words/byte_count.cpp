#include "simplify/words/byte_count.h"

#include <charconv>

namespace qtet {

std::optional<std::uint64_t> parseByteCount(std::string_view text) {
  constexpr std::string_view kUnits = "kMGT";
  constexpr std::size_t kMostDigits = 12;
  std::uint64_t unit = 1;
  if (!text.empty())
    if (const std::size_t at = kUnits.find(text.back()); at != std::string_view::npos) {
      for (std::size_t i = 0; i <= at; ++i) unit *= 1000;
      text.remove_suffix(1);
    }
  std::uint64_t number = 0;
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (text.empty() || text.size() > kMostDigits || end != text.data() + text.size() ||
      code != std::errc{})
    return std::nullopt;
  std::uint64_t out = 0;
  return __builtin_mul_overflow(number, unit, &out) ? std::nullopt : std::optional(out);
}

}  // namespace qtet
