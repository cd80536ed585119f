#include "server/stream/stream_input.h"

#include <gtest/gtest.h>

#include "server/stream/stream_limits.h"

namespace qtet {
namespace {

constexpr char kText = '\x81', kClose = '\x88', kPing = '\x89';

/// A session's input with everything behind it but the socket.
class StreamInputTest : public ::testing::Test {
 protected:
  /// A frame masked with zeros.
  static std::string frame(char first, const std::string& payload) {
    return std::string{first, static_cast<char>(0x80 | static_cast<int>(payload.size())), 0, 0, 0,
                       0} +
           payload;
  }
  void take(const std::string& bytes) { input_.take(bytes, now_); }
  /// The protocol's next message; "" if there is none.
  std::string said() {
    const std::optional<Outgoing> out = protocol_.next();
    const auto* text = out ? std::get_if<std::string>(&*out) : nullptr;
    return text ? *text : "";
  }
  std::optional<std::string> closed() {
    const std::optional<ControlFrame> frame = control_.takeClose();
    return frame ? std::optional(frame->payload) : std::nullopt;
  }

  MeshStore store_;
  StreamProtocol protocol_{store_};
  ControlFrames control_;
  StreamInput input_{protocol_, control_};
  StreamInput::Clock::time_point now_ = StreamInput::Clock::now();
};

TEST_F(StreamInputTest, messagesGoToTheProtocolAndPingsAreAnswered) {
  const std::string bytes = frame(kPing, "a") + frame(kText, R"({"type":"cancel"})");
  for (const char byte : bytes) take(std::string(1, byte));
  EXPECT_EQ(said(), toJson(StoppedMessage{0}));
  EXPECT_EQ(control_.takeSign(), (ControlFrame{WebSocketHeader::kPong, "a"}));
  EXPECT_TRUE(input_.listens());
}

TEST_F(StreamInputTest, behindACloseEverythingIsCountedAndNothingHeard) {
  take(frame(kClose, "\x03\xE8 bye") + frame(kText, R"({"type":"cancel"})"));
  EXPECT_FALSE(input_.listens());
  EXPECT_EQ(input_.ignoredBytes(), 0u) << "what came with the close counts for nothing";
  EXPECT_EQ(said(), "");
  EXPECT_EQ(closed(), "\x03\xE8") << "the client's own code";
  take(frame(kPing, "a"));
  EXPECT_EQ(input_.ignoredBytes(), 7u);
  EXPECT_EQ(control_.takeSign(), std::nullopt);
}

TEST_F(StreamInputTest, aFrameThatBreaksTheRulesIsTheLast) {
  take(std::string("\x81\x05hello"));
  EXPECT_FALSE(input_.listens());
  EXPECT_EQ(closed(), "\x03\xEA") << "1002: it is not masked";
}

TEST_F(StreamInputTest, pingsAreCountedAnewEverySecond) {
  for (unsigned second = 0; second < 2; ++second, now_ += std::chrono::seconds(1))
    for (unsigned i = 0; i < limits::kMaxPingsPerSecond; ++i) take(frame(kPing, ""));
  EXPECT_TRUE(input_.listens());
  now_ -= std::chrono::milliseconds(1);
  take(frame(kPing, ""));
  EXPECT_FALSE(input_.listens());
  EXPECT_EQ(closed(), "\x03\xF0") << "1008";
}

}  // namespace
}  // namespace qtet
