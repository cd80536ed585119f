// Accept-Encoding of RFC 9110, 12.5.3, and the two codings that this server has: gzip (RFC 1952)
// and zstd (RFC 8878).
#pragma once

#include <cstdint>
#include <string_view>

#include "proto/bytes.h"

namespace qtet {

enum class ContentCoding : std::uint8_t { kIdentity, kGzip, kZstd };

/// Below this a packet holds the text either way.
inline constexpr std::size_t kMinCompressedBytes = 1024;

/// "gzip", "zstd"; "" for identity.
[[nodiscard]] std::string_view codingName(ContentCoding coding);

/// The best of what the client takes and there is: the highest weight; zstd before gzip before
/// identity where weights are equal.
[[nodiscard]] ContentCoding chooseCoding(std::string_view acceptEncoding, bool gzip, bool zstd);

/// The bytes in that coding, always the same ones for the same input; as they are for kIdentity.
[[nodiscard]] Bytes encoded(Bytes bytes, ContentCoding coding);
/// The same, but empty where that would be no smaller. REQUIRES: not kIdentity.
[[nodiscard]] Bytes compressed(ByteView bytes, ContentCoding coding);
/// Whether `coded` is `bytes` in that coding, whole and with nothing behind it. REQUIRES: not
/// kIdentity.
[[nodiscard]] bool isCodingOf(ByteView coded, ContentCoding coding, ByteView bytes);

}  // namespace qtet
