#include "server/wire/http_gate.h"

#include <cassert>

#include "server/wire/http_limits.h"

namespace qtet {
namespace {

/// Whether a method may begin with `c`; a TLS handshake begins with 0x16.
bool isMethodCharacter(char c) {
  return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || c == '-' || c == '_' || c == '!' ||
         c == '*';
}

bool isControl(char c) {
  const auto byte = static_cast<unsigned char>(c);
  return (byte < 0x20 && c != '\t') || byte == 0x7F;
}

}  // namespace

HttpGate::Verdict HttpGate::look(std::string_view bytes) {
  assert(last_ == Verdict::kMore && bytes.size() >= checked_);
  return last_ = lookOn(bytes);
}

HttpGate::Verdict HttpGate::lookOn(std::string_view bytes) {
  for (; checked_ < bytes.size(); ++checked_) {
    const char c = bytes[checked_];
    if (checked_ == 0 && !isMethodCharacter(c)) return Verdict::kBroken;
    if (startsLine(bytes) && (c == ' ' || c == '\t')) return Verdict::kBroken;
    if (c == '\n') return Verdict::kBroken;  // its CR would have taken it along
    if (c != '\r') {
      if (isControl(c)) return Verdict::kBroken;
      continue;
    }
    if (checked_ + 1 == bytes.size()) return Verdict::kMore;  // decided by the next byte
    if (bytes[checked_ + 1] != '\n') return Verdict::kBroken;
    const bool empty = startsLine(bytes);
    ++checked_;
    if (empty) return ++checked_, Verdict::kComplete;
    if (++lines_ > limits::kMaxHeaderLines) return Verdict::kTooLong;
  }
  return Verdict::kMore;
}

std::size_t emptyLinesBefore(std::string_view bytes) {
  constexpr std::size_t kMax = 4;
  std::size_t out = 0;
  while (out < kMax && bytes.substr(out).starts_with("\r\n")) out += 2;
  return out;
}

}  // namespace qtet
