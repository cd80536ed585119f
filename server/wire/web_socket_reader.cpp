#include "server/wire/web_socket_reader.h"

#include <array>
#include <bit>
#include <boost/uuid/detail/sha1.hpp>
#include <cassert>

#include "proto/messages.h"
#include "proto/utf8.h"

namespace qtet {
namespace {

constexpr std::size_t kMaxControlBytes = 125;  // RFC 6455, 5.5
constexpr std::string_view kBase64 =
    "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

std::string base64(const std::array<std::uint8_t, 20>& bytes) {
  std::string out;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t have = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k) group = group << 8 | (k < have ? bytes[i + k] : 0u);
    for (std::size_t k = 0; k < 4; ++k)
      out += k <= have ? kBase64[group >> (18 - 6 * k) & 63] : '=';
  }
  return out;
}

}  // namespace

bool isCloseCode(std::uint16_t code) {
  return (code >= 1000 && code <= 1003) || (code >= 1007 && code <= 1014) ||
         (code >= 3000 && code <= 4999);
}

std::expected<std::optional<WebSocketReader::Frame>, CloseCode> WebSocketReader::takeFrame() {
  const auto at = [this](std::size_t i) { return static_cast<std::uint8_t>(buffer_[i]); };
  if (buffer_.size() < 2) return std::nullopt;
  const std::uint8_t opcode = at(0) & 0x0F;
  const bool control = (opcode & 8) != 0;
  if ((at(0) & 0x70) != 0 || (opcode > 2 && opcode < 8) || opcode > 10)
    return std::unexpected(CloseCode::kProtocol);
  if ((at(1) & 0x80) == 0) return std::unexpected(CloseCode::kProtocol);  // clients mask
  std::uint64_t size = at(1) & 0x7F;
  if (control && (size > kMaxControlBytes || (at(0) & 0x80) == 0))
    return std::unexpected(CloseCode::kProtocol);
  const std::size_t lengthBytes = size == 126 ? 2 : size == 127 ? 8 : 0;
  const std::size_t head = 2 + lengthBytes + 4;
  if (buffer_.size() < head) return std::nullopt;
  if (lengthBytes > 0) {
    size = 0;
    for (std::size_t i = 0; i < lengthBytes; ++i) size = size << 8 | at(2 + i);
    if (size < (lengthBytes == 2 ? 126u : 65536u) || std::bit_width(size) > 63)
      return std::unexpected(CloseCode::kProtocol);
  }
  // Checked before a byte of it is kept: what has come of the message and what is announced.
  if (!control && size > kMaxMessageBytes - message_.size())
    return std::unexpected(CloseCode::kTooBig);
  if (buffer_.size() - head < size) return std::nullopt;
  Frame out{(at(0) & 0x80) != 0, static_cast<Opcode>(opcode),
            buffer_.substr(head, static_cast<std::size_t>(size))};
  for (std::size_t i = 0; i < out.payload.size(); ++i)
    out.payload[i] = static_cast<char>(out.payload[i] ^ buffer_[head - 4 + i % 4]);
  buffer_.erase(0, head + static_cast<std::size_t>(size));
  if (buffer_.empty()) buffer_ = std::string();  // a silent client costs nothing
  return out;
}

std::expected<std::optional<WebSocketReader::Event>, CloseCode> WebSocketReader::control(
    Frame frame) const {
  assert(frame.last && frame.payload.size() <= kMaxControlBytes);
  if (frame.opcode == Opcode::kPing) return Event{Event::Kind::kPing, std::move(frame.payload)};
  if (frame.opcode == Opcode::kPong) return Event{Event::Kind::kPong, std::move(frame.payload)};
  if (frame.payload.size() == 1) return std::unexpected(CloseCode::kProtocol);
  if (!frame.payload.empty()) {
    const auto high = static_cast<std::uint8_t>(frame.payload[0]),
               low = static_cast<std::uint8_t>(frame.payload[1]);
    if (!isCloseCode(static_cast<std::uint16_t>(high << 8 | low)))
      return std::unexpected(CloseCode::kProtocol);
    if (!isUtf8(std::string_view(frame.payload).substr(2)))
      return std::unexpected(CloseCode::kBadText);
  }
  return Event{Event::Kind::kClose, std::move(frame.payload)};
}

std::expected<std::optional<WebSocketReader::Event>, CloseCode> WebSocketReader::data(Frame frame) {
  const bool continues = frame.opcode == Opcode::kContinuation;
  if (continues != kind_.has_value()) return std::unexpected(CloseCode::kProtocol);
  if (!continues) kind_ = frame.opcode;
  if (++fragments_ > limits::kMaxFragments) return std::unexpected(CloseCode::kPolicy);
  assert(frame.payload.size() <= kMaxMessageBytes - message_.size());  // takeFrame() saw to it
  message_ += frame.payload;
  if (!frame.last) return std::nullopt;
  Event out{*kind_ == Opcode::kText ? Event::Kind::kText : Event::Kind::kBinary,
            std::move(message_)};
  message_ = std::string();
  kind_.reset();
  fragments_ = 0;
  if (out.kind == Event::Kind::kText && !isUtf8(out.payload))
    return std::unexpected(CloseCode::kBadText);
  return out;
}

std::expected<std::optional<WebSocketReader::Event>, CloseCode> WebSocketReader::next() {
  assert(state_ != State::kBroken);
  auto event = takeEvent();
  if (!event)
    state_ = State::kBroken;
  else if (!*event)
    state_ = State::kHungry;
  return event;
}

std::expected<std::optional<WebSocketReader::Event>, CloseCode> WebSocketReader::takeEvent() {
  for (;;) {
    auto frame = takeFrame();
    if (!frame) return std::unexpected(frame.error());
    if (!*frame) return std::nullopt;
    const bool isControl = (static_cast<unsigned>((*frame)->opcode) & 8u) != 0;
    auto event = isControl ? control(std::move(**frame)) : data(std::move(**frame));
    if (!event || *event) return event;
  }
}

WebSocketHeader::WebSocketHeader(std::uint8_t kind, std::uint64_t payloadBytes) {
  const auto put = [this](std::uint64_t value, unsigned count) {
    for (unsigned i = count; i-- > 0;) bytes[size++] = static_cast<std::uint8_t>(value >> (8 * i));
  };
  const unsigned lengthBytes = payloadBytes < 126 ? 0 : payloadBytes < 65536 ? 2 : 8;
  put(kind, 1);
  put(lengthBytes == 0 ? payloadBytes : lengthBytes == 2 ? 126 : 127, 1);
  put(payloadBytes, lengthBytes);
  assert(size == 2 + lengthBytes);
}

std::string webSocketAccept(std::string_view key) {
  boost::uuids::detail::sha1 hash;
  hash.process_bytes(key.data(), key.size());
  constexpr std::string_view kGuid = "258EAFA5-E914-47DA-95CA-C5AB0DC85B11";
  hash.process_bytes(kGuid.data(), kGuid.size());
  boost::uuids::detail::sha1::digest_type words;
  hash.get_digest(words);
  std::array<std::uint8_t, 20> bytes{};
  for (std::size_t i = 0; i < bytes.size(); ++i)
    bytes[i] = static_cast<std::uint8_t>(words[i / 4] >> (24 - 8 * (i % 4)));
  return base64(bytes);
}

bool isWebSocketKey(std::string_view key) {
  return key.size() == 24 && key.ends_with("==") && key.find_first_not_of(kBase64) == 22;
}

}  // namespace qtet
