// Conditions and ranges of RFC 9110, sections 13 and 14, over values.
#pragma once

#include <cstdint>

#include "server/http/http_message.h"
#include "server/wire/resource.h"

namespace qtet {

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
