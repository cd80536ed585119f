// Fuzzes what a client sends over a WebSocket below its messages: whole and cut anywhere it means
// the same, and is within the limits.
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "proto/messages.h"
#include "proto/utf8.h"
#include "server/wire/web_socket_reader.h"

namespace {

using qtet::WebSocketReader;

struct Heard {
  std::vector<std::pair<int, std::string>> events;
  int closed = 0;

  bool operator==(const Heard&) const = default;
};

Heard hear(std::string_view bytes, std::size_t step) {
  Heard out;
  WebSocketReader reader;
  while (!bytes.empty()) {
    const std::string_view piece = bytes.substr(0, step);
    bytes.remove_prefix(piece.size());
    reader.feed(piece);
    for (;;) {
      auto event = reader.next();
      if (!event) return out.closed = static_cast<int>(event.error()), out;
      if (!*event) break;
      const bool message = (*event)->kind == WebSocketReader::Event::Kind::kText ||
                           (*event)->kind == WebSocketReader::Event::Kind::kBinary;
      if ((*event)->payload.size() > (message ? qtet::kMaxMessageBytes : 125)) std::abort();
      if ((*event)->kind == WebSocketReader::Event::Kind::kText && !qtet::isUtf8((*event)->payload))
        std::abort();
      out.events.emplace_back(static_cast<int>((*event)->kind), (*event)->payload);
    }
  }
  return out;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::string_view bytes(reinterpret_cast<const char*>(data) + 1, size - 1);
  if (hear(bytes, bytes.size() + 1) != hear(bytes, data[0] % 16 + std::size_t{1})) std::abort();
  return 0;
}
