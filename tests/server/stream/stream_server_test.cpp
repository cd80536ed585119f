// `/v1/stream` over a real socket, with Beast as the client.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <thread>
#include <vector>

#include "server/stream/stream_limits.h"
#include "tests/server/program/loopback.h"
#include "tests/server/program/served_folder.h"

namespace qtet {
namespace {

using test::StreamClient;

class StreamServerTest : public ::testing::Test {
 protected:
  static std::string open(std::uint64_t credit, const std::string& more = "") {
    return R"({"type":"open","mesh":"noise","credit":)" + std::to_string(credit) + more + "}";
  }
  static std::string credit(std::uint64_t bytes) {
    return R"({"type":"credit","bytes":)" + std::to_string(bytes) + "}";
  }

  static std::uint32_t openedStream(StreamClient& client) {
    const auto word = client.receiveWord();
    return word && std::holds_alternative<OpenedMessage>(*word)
               ? std::get<OpenedMessage>(*word).stream
               : 0;
  }
  static std::string errorCode(StreamClient& client) {
    const auto word = client.receiveWord();
    return word && std::holds_alternative<ErrorMessage>(*word) ? std::get<ErrorMessage>(*word).code
                                                               : "(no error)";
  }

  test::ServedFolder folder_;
  test::RunningServer server_{folder_.store(), folder_.viewer(), {.threads = 2}};
};

TEST_F(StreamServerTest, theSubprotocolMustBeOffered) {
  EXPECT_EQ(StreamClient(server_.port(), "").httpStatus(), 400u);
  EXPECT_EQ(StreamClient(server_.port(), "qtet.v2").httpStatus(), 400u);
  EXPECT_EQ(StreamClient(server_.port(), "qtet.v1", "/v1/streams").httpStatus(), 404u);
  const StreamClient client(server_.port(), "mqtt, qtet.v1");
  EXPECT_TRUE(client.connected());
  EXPECT_EQ(client.acceptedSubprotocol(), "qtet.v1");
  EXPECT_TRUE(StreamClient(server_.port(), "qtet.v1", "/v1/stream?from=page").connected());
}

TEST_F(StreamServerTest, aPlainRequestIsToldToUpgrade) {
  test::RawClient client(server_.port());
  const auto response = client.get("/v1/stream");
  EXPECT_EQ(response.status, 426u);
  EXPECT_EQ(response.header("upgrade"), "websocket");
}

TEST_F(StreamServerTest, allFramesTogetherAreTheFile) {
  StreamClient client(server_.port());
  ASSERT_TRUE(client.send(open(1 << 30, R"(,"fields":["density","velocity"])")));
  ASSERT_EQ(openedStream(client), 1u);
  std::string all;
  for (;;) {
    const auto message = client.receive();
    ASSERT_TRUE(message);
    if (!message->binary) break;
    ASSERT_TRUE(FrameHeader::parse(message->bytes));
    all.append(message->bytes.begin() + FrameHeader::kBytes, message->bytes.end());
  }
  EXPECT_EQ(all, folder_.file());
}

TEST_F(StreamServerTest, creditIsHonoured) {
  StreamClient client(server_.port());
  ASSERT_TRUE(client.send(open(0)));
  ASSERT_EQ(openedStream(client), 1u);
  EXPECT_FALSE(client.receive(test::kQuiet)) << "no credit, no frame";
  std::int64_t granted = 0;
  std::int64_t received = 0;
  for (;;) {
    ASSERT_TRUE(client.send(credit(3000)));
    granted += 3000;
    // The server sends while the credit is positive: it stops at the first frame that brings it to
    // zero or below.
    while (received < granted) {
      const auto message = client.receive();
      ASSERT_TRUE(message);
      if (!message->binary) return;
      received += static_cast<std::int64_t>(message->bytes.size() - FrameHeader::kBytes);
    }
    const auto more = client.receive(std::chrono::milliseconds(20));
    if (more) {
      EXPECT_FALSE(more->binary) << "a frame without credit";
      return;
    }
  }
}

/// Breaks off after n frames and comes back with `have`, for every n.
TEST_F(StreamServerTest, resumingBringsExactlyTheMissingBytes) {
  const LogIndex& index = folder_.mesh().log.index();
  for (std::size_t stopAfter = 0;; ++stopAfter) {
    std::string all;
    // whole ones: this mesh's chunks come as one frame each, being below the payload's bound
    std::uint32_t chunks = 0;
    bool done = false;
    {
      StreamClient client(server_.port());
      ASSERT_TRUE(client.send(open(1 << 30, R"(,"fields":["density","velocity"])")));
      ASSERT_EQ(openedStream(client), 1u);
      for (std::size_t n = 0; n < stopAfter && !done; ++n) {
        const auto message = client.receive();
        ASSERT_TRUE(message);
        if (!message->binary) {
          done = true;
          break;
        }
        const auto header = FrameHeader::parse(message->bytes);
        ASSERT_TRUE(header);
        if (header->firstPart != FrameHeader::kHead) {
          ASSERT_EQ(header->parts, index.parts());
          ++chunks;
        }
        all.append(message->bytes.begin() + FrameHeader::kBytes, message->bytes.end());
      }
      client.vanish();
    }
    if (done) return;
    if (chunks == 0) all.clear();  // have.chunks = 0 means from the head on
    StreamClient client(server_.port());
    const std::string n = std::to_string(chunks);
    ASSERT_TRUE(client.send(open(1 << 30, R"(,"fields":["density","velocity"],"have":{"chunks":)" +
                                              n + R"(,"fields":{"density":)" + n +
                                              R"(,"velocity":)" + n + "}}")));
    const auto word = client.receiveWord();
    ASSERT_TRUE(word);
    EXPECT_EQ(std::get<OpenedMessage>(*word).planned, folder_.file().size() - all.size());
    for (auto message = client.receive(); message && message->binary; message = client.receive())
      all.append(message->bytes.begin() + FrameHeader::kBytes, message->bytes.end());
    ASSERT_EQ(all, folder_.file()) << "broken off after " << stopAfter << " frames";
  }
}

TEST_F(StreamServerTest, aFieldChosenLaterIsSentAlone) {
  StreamClient client(server_.port());
  const LogIndex& index = folder_.mesh().log.index();
  ASSERT_TRUE(client.send(open(1 << 30, R"(,"fields":["velocity"],"have":{"chunks":12})")));
  ASSERT_EQ(openedStream(client), 1u);
  for (std::uint32_t chunk = 0; chunk < 12; ++chunk) {
    const auto message = client.receive();
    ASSERT_TRUE(message && message->binary);
    const auto header = FrameHeader::parse(message->bytes);
    ASSERT_TRUE(header);
    EXPECT_EQ(*header, (FrameHeader{1, chunk, 3, 1, index.block(chunk, 3).size}));
    EXPECT_TRUE(std::ranges::equal(ByteView(message->bytes).subspan(FrameHeader::kBytes),
                                   folder_.mesh().log.block(chunk, 3)));
  }
  EXPECT_TRUE(std::holds_alternative<DoneMessage>(*client.receiveWord()));
}

TEST_F(StreamServerTest, aSecondOpenSupersedesTheFirst) {
  StreamClient client(server_.port());
  ASSERT_TRUE(client.send(open(1)));
  ASSERT_EQ(openedStream(client), 1u);
  ASSERT_TRUE(client.receive()->binary);  // the head; the credit is gone
  ASSERT_TRUE(client.send(open(1 << 30, R"(,"have":{"chunks":11})")));
  ASSERT_EQ(openedStream(client), 2u);
  const auto frame = client.receive();
  ASSERT_TRUE(frame && frame->binary);
  EXPECT_EQ(FrameHeader::parse(frame->bytes)->stream, 2u);
  EXPECT_EQ(FrameHeader::parse(frame->bytes)->chunk, 11u);
  EXPECT_EQ(std::get<DoneMessage>(*client.receiveWord()).stream, 2u);
}

TEST_F(StreamServerTest, stopStopsAndTheSocketStays) {
  StreamClient client(server_.port());
  ASSERT_TRUE(client.send(open(1)));
  ASSERT_EQ(openedStream(client), 1u);
  ASSERT_TRUE(client.receive()->binary);
  ASSERT_TRUE(client.send(R"({"type":"stop"})"));
  EXPECT_EQ(std::get<StoppedMessage>(*client.receiveWord()).stream, 1u);
  ASSERT_TRUE(client.send(credit(1 << 20)));
  EXPECT_FALSE(client.receive(test::kQuiet));
  ASSERT_TRUE(client.send(open(0)));
  EXPECT_EQ(openedStream(client), 2u);
  client.close();
}

TEST_F(StreamServerTest, mistakesOfNameLeaveTheSocketOpen) {
  StreamClient client(server_.port());
  ASSERT_TRUE(client.send(R"({"type":"open","mesh":"nothing","credit":1})"));
  EXPECT_EQ(errorCode(client), "not-found");
  ASSERT_TRUE(client.send(open(1, R"(,"fields":["pressure"])")));
  EXPECT_EQ(errorCode(client), "unknown-field");
  ASSERT_TRUE(client.send(open(1, R"(,"digest":")" + std::string(64, 'f') + "\"")));
  EXPECT_EQ(errorCode(client), "log-changed");
  ASSERT_TRUE(client.send(open(0)));
  EXPECT_EQ(openedStream(client), 4u);
}

TEST_F(StreamServerTest, whatIsNotUnderstoodIsExplainedAndClosedWith1008) {
  for (const char* text : {"hello", "{}", "[]", "", R"({"type":"credit"})",
                           R"({"type":"open","mesh":"noise","credit":-1})"}) {
    StreamClient client(server_.port());
    ASSERT_TRUE(client.send(text));
    EXPECT_EQ(errorCode(client), "bad-message") << text;
    EXPECT_EQ(client.closeCode(), 1008u) << text;
  }
  StreamClient binary(server_.port());
  ASSERT_TRUE(binary.sendBinary("\1\2\3"));
  EXPECT_EQ(errorCode(binary), "bad-message");
  EXPECT_EQ(binary.closeCode(), 1008u);
}

TEST_F(StreamServerTest, aMessageTooLongClosesWith1009AndBadUtf8With1007) {
  StreamClient large(server_.port());
  large.send(std::string(kMaxMessageBytes + 1, ' '));
  EXPECT_EQ(large.closeCode(), 1009u);
  StreamClient bad(server_.port());
  ASSERT_TRUE(bad.send("\xC3\x28"));
  EXPECT_EQ(bad.closeCode(), 1007u);
}

TEST_F(StreamServerTest, oneBadClientEndsOneSessionOnly) {
  StreamClient good(server_.port());
  ASSERT_TRUE(good.send(open(1)));
  ASSERT_EQ(openedStream(good), 1u);
  {
    StreamClient bad(server_.port());
    bad.send("nonsense");
    StreamClient gone(server_.port());
    gone.send(open(1 << 30, R"(,"fields":["density","velocity"])"));
    gone.vanish();
  }
  ASSERT_TRUE(good.receive()->binary);
  ASSERT_TRUE(good.send(credit(1 << 30)));
  EXPECT_TRUE(good.receive()->binary);
}

TEST_F(StreamServerTest, aClientThatSaysGoodByeIsAnsweredInKind) {
  StreamClient client(server_.port());
  ASSERT_TRUE(client.send(open(0)));
  ASSERT_EQ(openedStream(client), 1u);
  client.close();
  EXPECT_EQ(client.closeCode(), 1000u);
}

TEST_F(StreamServerTest, theServersEndClosesWith1001) {
  StreamClient waiting(server_.port());
  ASSERT_TRUE(waiting.send(open(0)));
  ASSERT_EQ(openedStream(waiting), 1u);
  StreamClient silent(server_.port());
  ASSERT_TRUE(silent.connected());
  server_.stop();
  EXPECT_EQ(waiting.closeCode(), 1001u);
  EXPECT_EQ(silent.closeCode(), 1001u);
  server_.join();
}

/// A connection after its handshake, to send what no library sends.
class RawStream : public test::RawClient {
 public:
  explicit RawStream(std::uint16_t port) : RawClient(port) {
    send(
        "GET /v1/stream HTTP/1.1\r\nHost: localhost\r\nUpgrade: websocket\r\nConnection: "
        "Upgrade\r\nSec-WebSocket-Version: 13\r\n"
        "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Protocol: qtet.v1\r\n\r\n");
    accepted = receive(true).status == 101;
  }
  /// A frame masked with zeros.
  static std::string frame(char first, const std::string& payload) {
    return std::string{first, static_cast<char>(0x80 | static_cast<int>(payload.size())), 0, 0, 0,
                       0} +
           payload;
  }
  bool accepted = false;
};

TEST_F(StreamServerTest, pingsAreAnsweredAndACloseIsEchoed) {
  RawStream client(server_.port());
  ASSERT_TRUE(client.accepted);
  ASSERT_TRUE(
      client.send(RawStream::frame('\x89', "hi") + RawStream::frame('\x88', "\x03\xE8 bye")));
  EXPECT_EQ(client.readToEnd(), "\x8A\x02hi\x88\x02\x03\xE8");
}

// Floods are sent at once, several times what a second allows: so also a machine that stalls among
// them has more in one second.
TEST_F(StreamServerTest, tooManyMessagesCloseWith1008) {
  RawStream flood(server_.port());
  ASSERT_TRUE(flood.accepted);
  std::string opens;
  for (unsigned i = 0; i < 8 * limits::kMaxOpensPerSecond; ++i)
    opens += RawStream::frame('\x81', open(0));
  ASSERT_TRUE(flood.send(opens));
  EXPECT_TRUE(flood.readToEnd().ends_with("\x88\x02\x03\xF0"));
}

TEST_F(StreamServerTest, unmaskedFramesCloseWith1002AndFloodsOfPingsWith1008) {
  RawStream unmasked(server_.port());
  ASSERT_TRUE(unmasked.send(std::string("\x81\x05hello")));
  EXPECT_EQ(unmasked.readToEnd(), "\x88\x02\x03\xEA");
  RawStream flood(server_.port());
  std::string pings;
  for (unsigned i = 0; i < 8 * limits::kMaxPingsPerSecond; ++i)
    pings += RawStream::frame('\x89', "");
  ASSERT_TRUE(flood.send(pings));
  EXPECT_TRUE(flood.readToEnd().ends_with("\x88\x02\x03\xF0"));
}

TEST_F(StreamServerTest, aHandshakeOfAnotherVersionOrWithABadKeyIsRefused) {
  const std::string start =
      "GET /v1/stream HTTP/1.1\r\nHost: localhost\r\nUpgrade: websocket\r\nConnection: "
      "Upgrade\r\nSec-WebSocket-Protocol: qtet.v1\r\n";
  test::RawClient old(server_.port());
  ASSERT_TRUE(old.send(
      start + "Sec-WebSocket-Version: 8\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n"));
  const auto answer = old.receive();
  EXPECT_EQ(answer.status, 426u);
  EXPECT_EQ(answer.header("sec-websocket-version"), "13");
  test::RawClient bad(server_.port());
  ASSERT_TRUE(bad.send(start + "Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: hello\r\n\r\n"));
  EXPECT_EQ(bad.receive().status, 400u);
}

TEST_F(StreamServerTest, aHandshakeOfHttp10IsNone) {
  test::RawClient client(server_.port());
  client.send(
      "GET /v1/stream HTTP/1.0\r\nHost: a\r\nUpgrade: websocket\r\nConnection: "
      "Upgrade\r\nSec-WebSocket-Version: 13\r\n"
      "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Protocol: qtet.v1\r\n\r\n");
  EXPECT_EQ(client.receive().status, 426u);
}

TEST_F(StreamServerTest, aStreamMayFollowOtherRequestsAndBeFollowedByItsFirstWordsAtOnce) {
  test::RawClient client(server_.port());
  client.send(
      "GET /livez HTTP/1.1\r\nHost: a\r\n\r\n"
      "GET /v1/stream HTTP/1.1\r\nHost: a\r\nUpgrade: other\r\nUpgrade: websocket\r\nConnection: "
      "keep-alive\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
      "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Protocol: "
      "other\r\nSec-WebSocket-Protocol: qtet.v1\r\n\r\n" +
      RawStream::frame('\x81', open(0)));
  EXPECT_EQ(client.receive().status, 200u);
  EXPECT_EQ(client.receive(true).status, 101u);
  ASSERT_TRUE(client.answerBegins());
  client.send(RawStream::frame('\x88', ""));
  const std::string rest = client.readToEnd();
  EXPECT_NE(rest.find("\"opened\""), std::string::npos);
  EXPECT_TRUE(rest.ends_with(std::string("\x88\0", 2)));
}

TEST_F(StreamServerTest, pagesOfOtherOriginsMayBeKeptOut) {
  const auto status = [](std::uint16_t port, const std::string& origin) {
    test::RawClient client(port);
    client.send(
        "GET /v1/stream HTTP/1.1\r\nHost: localhost\r\nUpgrade: websocket\r\nConnection: "
        "Upgrade\r\nSec-WebSocket-Version: 13\r\n"
        "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Protocol: qtet.v1\r\n" +
        origin + "\r\n");
    return client.receive(true).status;
  };
  test::RunningServer server(folder_.store(), folder_.viewer(),
                             {.allowedOrigins = {"https://a.example", "https://b.example"}});
  EXPECT_EQ(status(server.port(), "Origin: https://b.example\r\n"), 101u);
  EXPECT_EQ(status(server.port(), "Origin: https://b.example.evil\r\n"), 403u);
  EXPECT_EQ(status(server.port(), "Origin: null\r\n"), 403u);
  EXPECT_EQ(status(server.port(), ""), 101u);
  EXPECT_EQ(status(server_.port(), "Origin: https://c.example\r\n"), 101u);
}

TEST_F(StreamServerTest, theServersEndSendsWhatTheCreditAllows) {
  StreamClient client(server_.port());
  ASSERT_TRUE(client.send(open(1 << 30, R"(,"fields":["density","velocity"])")));
  ASSERT_EQ(openedStream(client), 1u);
  server_.stop();
  std::string all;
  for (auto message = client.receive(); message && message->binary; message = client.receive())
    all.append(message->bytes.begin() + FrameHeader::kBytes, message->bytes.end());
  EXPECT_EQ(all, folder_.file());
  EXPECT_EQ(client.closeCode(), 1001u);
  server_.join();
}

TEST_F(StreamServerTest, aFrameComesWhileMessagesGoOut) {
  RawStream client(server_.port());
  ASSERT_TRUE(client.send(RawStream::frame('\x81', open(1)) + RawStream::frame('\x89', "x") +
                          RawStream::frame('\x88', "")));
  const std::string all = client.readToEnd();
  EXPECT_TRUE(all.ends_with(std::string("\x88\0", 2)));
}

TEST_F(StreamServerTest, manyClientsAtOnceEachGetTheirFile) {
  std::vector<std::jthread> threads;
  std::atomic<int> whole = 0;
  for (int i = 0; i < 8; ++i)
    threads.emplace_back([&] {
      StreamClient client(server_.port());
      client.send(open(1 << 30, R"(,"fields":["density","velocity"])"));
      (void)client.receive();
      std::string all;
      for (auto message = client.receive(); message && message->binary; message = client.receive())
        all.append(message->bytes.begin() + FrameHeader::kBytes, message->bytes.end());
      if (all == folder_.file()) ++whole;
    });
  threads.clear();
  EXPECT_EQ(whole, 8);
}

}  // namespace
}  // namespace qtet
