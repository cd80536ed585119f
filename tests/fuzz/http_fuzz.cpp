// Fuzzes the gate before HTTP's parser: a head that grows byte by byte gets the same verdict as the
// whole one. No stray line end or control byte passes.
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "server/wire/http_gate.h"
#include "server/wire/http_limits.h"
#include "server/wire/request_target.h"

using qtet::HttpGate;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size > qtet::limits::kMaxHeaderBytes) return 0;
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  HttpGate whole;
  const HttpGate::Verdict verdict = whole.look(bytes);
  HttpGate grown;
  HttpGate::Verdict last = HttpGate::Verdict::kMore;
  for (std::size_t n = 1; n <= size && last == HttpGate::Verdict::kMore; ++n)
    last = grown.look(bytes.substr(0, n));
  if (size > 0 && last != verdict) std::abort();
  if (verdict == HttpGate::Verdict::kComplete) {
    const std::string_view head = bytes.substr(0, whole.headBytes());
    if (grown.headBytes() != head.size() || !head.ends_with("\r\n\r\n")) std::abort();
    if (std::ranges::any_of(head, [](char c) {
          return (static_cast<unsigned char>(c) < 32 && c != '\r' && c != '\n' && c != '\t') ||
                 c == 127;
        }))
      std::abort();
    if (std::ranges::count(head, '\r') != std::ranges::count(head, '\n')) std::abort();
  }
  // A target that is written again means the same.
  if (const auto target = qtet::parseTarget(bytes)) {
    std::string again;
    for (const std::string& segment : target->segments) again += "/" + qtet::percentEncode(segment);
    const auto same = qtet::parseTarget(again);
    if (!same || same->segments != target->segments) std::abort();
  }
  return 0;
}
