// Conditions and ranges of RFC 9110, sections 13 and 14, over values.
#pragma once

#include <cstdint>
#include <ctime>
#include <optional>
#include <string>
#include <string_view>

#include "server/http/http_message.h"

namespace qtet {

/// "Sun, 06 Nov 1994 08:49:37 GMT".
[[nodiscard]] std::string httpDate(std::time_t time);
/// The form above, and the two that old clients send (RFC 9110, 5.6.7): "Sunday, 06-Nov-94 08:49:37
/// GMT" and "Sun Nov  6 08:49:37 1994". Anything else is no date.
[[nodiscard]] std::optional<std::time_t> parseHttpDate(std::string_view text);

/// The values by which conditions compare a resource. `etag` is strong and has its quotes.
struct Validators {
  std::string etag;
  std::time_t modified = 0;
  /// For a coded variant, the tag of the uncoded one; else empty. If-Match accepts this tag too,
  /// since both stand for the same state of the resource.
  std::string plainEtag{};
};

enum class Verdict { kSend, kNotModified, kPreconditionFailed };
/// If-Match, If-Unmodified-Since, If-None-Match and If-Modified-Since in the order of RFC 9110,
/// 13.2.2.
[[nodiscard]] Verdict evaluateConditions(const RequestView& request, const Validators& resource);

struct ByteRange {
  enum class Kind { kWhole, kPart, kUnsatisfiable };
  Kind kind = Kind::kWhole;
  std::uint64_t first = 0;
  std::uint64_t size = 0;
};
/// One range of a file of `bytes` bytes. kWhole where there is none, or one that may be ignored:
/// other units, several ranges, nonsense, or an If-Range that names another version.
[[nodiscard]] ByteRange selectRange(const RequestView& request, const Validators& resource,
                                    std::uint64_t bytes);

}  // namespace qtet
