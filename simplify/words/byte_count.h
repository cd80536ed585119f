// Numbers of bytes as people write them: 4G, 500M.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace qtet {

/// A number of at most 12 digits, and nothing, k, M, G or T behind it: thousands, and so on.
/// Nothing where the text is none.
[[nodiscard]] std::optional<std::uint64_t> parseByteCount(std::string_view text);

}  // namespace qtet
