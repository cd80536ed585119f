#include "server/stream/control_frames.h"

#include <gtest/gtest.h>

namespace qtet {
namespace {

const ControlFrame kGoingAwayFrame{WebSocketHeader::kClose, "\x03\xE9"};

TEST(ControlFrames, theLastPingAloneIsAnswered) {
  ControlFrames frames;
  EXPECT_EQ(frames.takeSign(), std::nullopt);
  frames.pong("first");
  frames.pong("last");
  frames.ping();
  EXPECT_EQ(frames.takeSign(), (ControlFrame{WebSocketHeader::kPong, "last"}));
  EXPECT_EQ(frames.takeSign(), (ControlFrame{WebSocketHeader::kPing, ""}));
  EXPECT_EQ(frames.takeSign(), std::nullopt);
}

TEST(ControlFrames, oneCloseFrameGoesOutWithTheFirstReason) {
  ControlFrames frames;
  EXPECT_FALSE(frames.closing());
  EXPECT_EQ(frames.takeClose(), std::nullopt);
  frames.close(CloseCode::kGoingAway);
  frames.close(CloseCode::kPolicy);
  EXPECT_TRUE(frames.closing());
  EXPECT_FALSE(frames.closed());
  EXPECT_EQ(frames.takeClose(), kGoingAwayFrame);
  EXPECT_TRUE(frames.closed());
  frames.close(CloseCode::kInternal);
  frames.answerClose("\x03\xE8");
  EXPECT_EQ(frames.takeClose(), std::nullopt);
  EXPECT_TRUE(frames.closed());
}

TEST(ControlFrames, aClientsCloseIsAnsweredByItsCode) {
  ControlFrames frames;
  frames.close(CloseCode::kGoingAway);
  frames.answerClose("\x03\xE8 bye");
  EXPECT_EQ(frames.takeClose(), (ControlFrame{WebSocketHeader::kClose, "\x03\xE8"}));
  ControlFrames withoutCode;
  withoutCode.answerClose("");
  EXPECT_EQ(withoutCode.takeClose(), (ControlFrame{WebSocketHeader::kClose, ""}));
}

}  // namespace
}  // namespace qtet
