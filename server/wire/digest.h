// SHA-256 by OpenSSL, which uses the processor's own instructions for it: for logs, tags, keys and
// secrets. proto/checksum.h has the one that also runs in a browser.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "proto/bytes.h"

namespace qtet {

using Digest = std::array<std::uint8_t, 32>;

/// Thread-safe, as all of this. Throws where OpenSSL has no SHA-256 or no memory.
[[nodiscard]] Digest digestOf(ByteView bytes);
[[nodiscard]] Digest digestOf(std::string_view text);
/// In lower-case hexadecimal.
[[nodiscard]] std::string hexDigestOf(ByteView bytes);
[[nodiscard]] std::string hexDigestOf(std::string_view text);
/// nullopt: the text is not 64 lower-case hexadecimal digits.
[[nodiscard]] std::optional<Digest> digestOfHex(std::string_view hex);

/// The first half of it: 128 bits tell versions of a text apart, and go with every answer.
[[nodiscard]] std::string tagOf(ByteView bytes);
[[nodiscard]] std::string tagOf(std::string_view text);

}  // namespace qtet
