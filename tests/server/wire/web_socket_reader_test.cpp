#include "server/wire/web_socket_reader.h"

#include <gtest/gtest.h>

#include "proto/messages.h"

namespace qtet {
namespace {

using Kind = WebSocketReader::Event::Kind;

/// A masked frame as a client sends it. `first` = FIN, reserved bits and opcode.
std::string frame(unsigned first, const std::string& payload, bool masked = true) {
  std::string out(1, static_cast<char>(first));
  const auto mask = static_cast<char>(masked ? 0x80 : 0);
  if (payload.size() < 126) {
    out += static_cast<char>(mask | static_cast<char>(payload.size()));
  } else if (payload.size() < 65536) {
    out += static_cast<char>(mask | 126);
    for (int shift : {8, 0}) out += static_cast<char>(payload.size() >> shift);
  } else {
    out += static_cast<char>(mask | 127);
    for (int shift : {56, 48, 40, 32, 24, 16, 8, 0})
      out += static_cast<char>(payload.size() >> shift);
  }
  if (!masked) return out + payload;
  const std::string key = "\x37\xFA\x21\x3D";
  out += key;
  for (std::size_t i = 0; i < payload.size(); ++i)
    out += static_cast<char>(payload[i] ^ key[i % 4]);
  return out;
}

struct Heard {
  std::vector<std::pair<Kind, std::string>> events;
  int closed = 0;
  bool operator==(const Heard&) const = default;
};

/// Feeds a reader the bytes in pieces and collects its events.
Heard hear(std::string_view bytes, std::size_t step = 1u << 20) {
  Heard out;
  WebSocketReader reader;
  for (; !bytes.empty(); bytes.remove_prefix(std::min(step, bytes.size()))) {
    reader.feed(bytes.substr(0, step));
    for (;;) {
      auto event = reader.next();
      if (!event) return out.closed = static_cast<int>(event.error()), out;
      if (!*event) break;
      out.events.emplace_back((*event)->kind, (*event)->payload);
    }
  }
  return out;
}

int closeCode(const std::string& bytes) { return hear(bytes).closed; }

TEST(WebSocketReader, messagesComeOutWholeHoweverTheyAreCut) {
  const std::string large(300, 'x');
  const std::string bytes = frame(0x81, "hello") + frame(0x82, large) + frame(0x01, "a\xC3") +
                            frame(0x89, "ping") + frame(0x00, "") + frame(0x80, "\xA4z") +
                            frame(0x8A, "") + frame(0x88, "\x03\xE8 bye");
  const Heard whole = hear(bytes);
  EXPECT_EQ(whole.closed, 0);
  EXPECT_EQ(whole.events,
            (std::vector<std::pair<Kind, std::string>>{{Kind::kText, "hello"},
                                                       {Kind::kBinary, large},
                                                       {Kind::kPing, "ping"},
                                                       {Kind::kText, "a\xC3\xA4z"},
                                                       {Kind::kPong, ""},
                                                       {Kind::kClose, "\x03\xE8 bye"}}));
  for (std::size_t step = 1; step < 40; ++step) EXPECT_EQ(hear(bytes, step), whole) << step;
}

TEST(WebSocketReader, aFrameThatBreaksTheRulesClosesWith1002) {
  EXPECT_EQ(closeCode(frame(0x81, "hello", false)), 1002) << "unmasked";
  for (const unsigned reserved : {0x10u, 0x20u, 0x40u})
    EXPECT_EQ(closeCode(frame(0x81 | reserved, "")), 1002);
  for (const unsigned opcode : {3u, 4u, 5u, 6u, 7u, 11u, 12u, 13u, 14u, 15u})
    EXPECT_EQ(closeCode(frame(0x80 | opcode, "")), 1002) << opcode;
  EXPECT_EQ(closeCode(frame(0x80, "x")), 1002) << "nothing to continue";
  EXPECT_EQ(closeCode(frame(0x01, "x") + frame(0x81, "y")), 1002) << "a message within a message";
  EXPECT_EQ(closeCode(frame(0x09, "")), 1002) << "a ping in fragments";
  EXPECT_EQ(closeCode(frame(0x89, std::string(125, 'x'))), 0);
  EXPECT_EQ(closeCode(frame(0x89, std::string(126, 'x'))), 1002);
  EXPECT_EQ(closeCode(std::string("\x81\xFF\x80\0\0\0\0\0\0\x01", 10) + "mask"), 1002)
      << "a negative length";
}

/// RFC 6455, 5.2: a length is written in as few bytes as possible.
TEST(WebSocketReader, aLengthInMoreBytesThanItNeedsClosesWith1002) {
  const auto framed = [](std::uint64_t size, unsigned lengthBytes) {
    std::string out = "\x82";
    out += static_cast<char>(0x80 | (lengthBytes == 2 ? 126 : 127));
    for (unsigned i = lengthBytes; i-- > 0;) out += static_cast<char>(size >> (8 * i));
    return out + std::string(4 + size, '\0');
  };
  for (const std::uint64_t size : {0u, 125u}) EXPECT_EQ(closeCode(framed(size, 2)), 1002) << size;
  for (const std::uint64_t size : {126u, 65535u}) EXPECT_EQ(closeCode(framed(size, 2)), 0) << size;
  for (const std::uint64_t size : {0u, 125u, 126u, 65535u})
    EXPECT_EQ(closeCode(framed(size, 8)), 1002) << size;
  EXPECT_EQ(closeCode(framed(65536, 8)), 0);
}

TEST(WebSocketReader, aCloseSaysWhatMayBeSaid) {
  const auto closing = [](unsigned code) {
    return frame(0x88, {static_cast<char>(code >> 8), static_cast<char>(code & 0xFF)});
  };
  for (const unsigned code : {1000u, 1001u, 1003u, 1007u, 1014u, 3000u, 4999u})
    EXPECT_EQ(closeCode(closing(code)), 0) << code;
  for (const unsigned code : {0u, 999u, 1004u, 1005u, 1006u, 1015u, 2999u, 5000u, 65535u})
    EXPECT_EQ(closeCode(closing(code)), 1002) << code;
  EXPECT_EQ(closeCode(frame(0x88, "")), 0);
  EXPECT_EQ(closeCode(frame(0x88, "\x03")), 1002);
  EXPECT_EQ(closeCode(frame(0x88, "\x03\xE8\xC3")), 1007);
}

/// Beast 1.74 let the last of these through.
TEST(WebSocketReader, textThatIsNotUtf8ClosesWith1007) {
  EXPECT_EQ(closeCode(frame(0x81, "\xC3\x28")), 1007);
  EXPECT_EQ(closeCode(frame(0x01, "\xC3") + frame(0x80, "\x28")), 1007);
  EXPECT_EQ(closeCode(frame(0x01, "a\xE2\x82") + frame(0x80, "")), 1007);
  EXPECT_EQ(closeCode(frame(0x82, "\xC3\x28")), 0) << "binary is not looked at";
}

TEST(WebSocketReader, aMessageTooLongIsRefusedByItsHeader) {
  EXPECT_EQ(closeCode(frame(0x81, std::string(kMaxMessageBytes, ' '))), 0);
  EXPECT_EQ(closeCode(frame(0x81, std::string(kMaxMessageBytes + 1, ' ')).substr(0, 14)), 1009);
  EXPECT_EQ(closeCode(frame(0x01, std::string(kMaxMessageBytes, ' ')) + frame(0x80, "")), 0);
  EXPECT_EQ(closeCode(frame(0x01, std::string(kMaxMessageBytes, ' ')) + frame(0x80, " ")), 1009);
}

TEST(WebSocketReader, aMessageHasABoundedNumberOfFragments) {
  std::string bytes = frame(0x01, "");
  for (std::size_t i = 2; i < limits::kMaxFragments; ++i) bytes += frame(0x00, "");
  EXPECT_EQ(hear(bytes + frame(0x80, "")).events.size(), 1u);
  EXPECT_EQ(closeCode(bytes + frame(0x00, "") + frame(0x80, "")), 1008);
}

TEST(WebSocketReader, itsHandshakeIsThatOfTheRfc) {
  EXPECT_EQ(webSocketAccept("dGhlIHNhbXBsZSBub25jZQ=="), "s3pPLMBiTxaQ9kYGzzhZRbK+xOo=");
  EXPECT_TRUE(isWebSocketKey("dGhlIHNhbXBsZSBub25jZQ=="));
  for (const char* bad : {"", "dGhlIHNhbXBsZSBub25jZQ=", "dGhlIHNhbXBsZSBub25jZQ===",
                          "dGhlIHNhbXBsZSBub25j Q==", "dGhlIHNhbXBsZSBub25jZQQQ"})
    EXPECT_FALSE(isWebSocketKey(bad)) << bad;
}

TEST(WebSocketHeader, lengthsTakeTheFewestBytes) {
  const auto header = [](std::uint64_t size) {
    const WebSocketHeader h(WebSocketHeader::kBinary, size);
    return std::string(reinterpret_cast<const char*>(h.bytes), h.size);
  };
  EXPECT_EQ(header(125), std::string("\x82\x7D"));
  EXPECT_EQ(header(126), std::string("\x82\x7E\0\x7E", 4));
  EXPECT_EQ(header(65535), std::string("\x82\x7E\xFF\xFF"));
  EXPECT_EQ(header(65536), std::string("\x82\x7F\0\0\0\0\0\x01\0\0", 10));
}

}  // namespace
}  // namespace qtet
