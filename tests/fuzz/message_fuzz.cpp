// Fuzzes what comes over a WebSocket, at either end: what is accepted is written and read again and
// must be the same.
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "proto/messages.h"

namespace {

template <class Parse>
void parseTwice(std::string_view text, const Parse& parse) {
  const auto message = parse(text);
  if (!message) return;
  const std::string written = qtet::toJson(*message);
  const auto again = parse(written);
  if (!again || qtet::toJson(*again) != written) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  parseTwice(text, qtet::parseClientMessage);
  parseTwice(text, qtet::parseServerMessage);
  if (const auto header = qtet::FrameHeader::parse(qtet::ByteView(data, size))) {
    const auto bytes = header->encode();
    if (!std::equal(bytes.begin(), bytes.end(), data)) std::abort();
  }
  return 0;
}
