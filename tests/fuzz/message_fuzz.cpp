// Fuzzes what a stranger sends a server: WebSocket messages, and the manifest that a damaged log would carry.
#include <cstdint>
#include <string_view>

#include "proto/manifest.h"
#include "proto/messages.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  (void)qtet::parseClientMessage(text);
  (void)qtet::FrameHeader::parse(qtet::ByteView(data, size));
  if (const auto manifest = qtet::manifestFromJson(text); manifest && !qtet::manifestFromJson(qtet::manifestToJson(*manifest))) __builtin_trap();
  return 0;
}
