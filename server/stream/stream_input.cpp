#include "server/stream/stream_input.h"

#include <utility>

#include "server/stream/stream_limits.h"

namespace qtet {

using Event = WebSocketReader::Event;

bool StreamInput::countPing(Clock::time_point now) {
  if (now - second_ >= std::chrono::seconds(1)) second_ = now, pings_ = 0;
  return ++pings_ <= limits::kMaxPingsPerSecond;
}

bool StreamInput::handle(Event event, Clock::time_point now) {
  switch (event.kind) {
    case Event::Kind::kText: protocol_.receive(event.payload, now); break;
    case Event::Kind::kBinary: protocol_.receiveBinary(); break;
    case Event::Kind::kPong: break;
    case Event::Kind::kPing:
      if (!countPing(now)) return control_.close(CloseCode::kPolicy), false;
      control_.pong(std::move(event.payload));
      break;
    case Event::Kind::kClose: control_.answerClose(event.payload); return false;
  }
  return true;
}

void StreamInput::take(std::string_view bytes, Clock::time_point now) {
  if (ignored_) {
    *ignored_ += bytes.size();
    return;
  }
  reader_.feed(bytes);
  for (bool goesOn = true; goesOn;) {
    auto event = reader_.next();
    if (event && !*event) return;
    if (!event) control_.close(event.error());
    goesOn = event && handle(std::move(**event), now);
  }
  ignored_ = 0;
}

}  // namespace qtet
