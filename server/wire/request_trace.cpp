#include "server/wire/request_trace.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <random>

namespace qtet {
namespace {

constexpr std::size_t kMaxIdCharacters = 128;
// "00-" + 32 + "-" + 16 + "-" + 2 (W3C Trace Context, 3.2)
constexpr std::size_t kTraceparentCharacters = 55;

std::string hex16(std::uint64_t value) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string out(16, '0');
  for (std::size_t i = 16; i-- > 0; value >>= 4) out[i] = kDigits[value & 15];
  return out;
}

/// Different for each request of this process and, most likely, of any other.
std::uint64_t fresh() {
  thread_local std::mt19937_64 random = [] {
    std::random_device device;
    std::seed_seq seed{device(), device(), device(), device()};
    return std::mt19937_64(seed);
  }();
  return random() | 1;  // all zeros would be no id
}

bool isId(std::string_view text) {
  return !text.empty() && text.size() <= kMaxIdCharacters && std::ranges::all_of(text, [](char c) {
    return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '-' ||
           c == '_' || c == '.';
  });
}

bool isHex(std::string_view text) {
  return text.find_first_not_of("0123456789abcdef") == std::string_view::npos;
}
bool isZero(std::string_view text) { return text.find_first_not_of('0') == std::string_view::npos; }

bool isTraceparent(std::string_view text) {
  return text.size() == kTraceparentCharacters && text.starts_with("00-") && text[35] == '-' &&
         text[52] == '-' && isHex(text.substr(3, 32)) && isHex(text.substr(36, 16)) &&
         isHex(text.substr(53)) && !isZero(text.substr(3, 32)) && !isZero(text.substr(36, 16));
}

}  // namespace

std::string RequestTrace::traceparent() const {
  return traceId.empty() ? "" : "00-" + traceId + "-" + spanId + "-" + flags;
}

RequestTrace traceOf(std::optional<std::string_view> requestId,
                     std::optional<std::string_view> traceparent) {
  RequestTrace out;
  out.id = requestId && isId(*requestId) ? std::string(*requestId) : hex16(fresh());
  if (!traceparent || !isTraceparent(*traceparent)) return out;
  out.traceId = traceparent->substr(3, 32);
  out.parentId = traceparent->substr(36, 16);
  out.flags = traceparent->substr(53);
  out.spanId = hex16(fresh());
  return out;
}

}  // namespace qtet
