#include "server/stream_protocol.h"

#include <gtest/gtest.h>

#include "server/limits.h"
#include "tests/server/synthetic_log.h"

namespace qtet {
namespace {

class StreamProtocolTest : public testing::Test {
 protected:
  void SetUp() override {
    folder_.write("noise.qtet", test::makeLog({.chunks = 6}));
    Result<MeshStore> store = MeshStore::open(folder_.path());
    ASSERT_TRUE(store);
    store_.emplace(std::move(*store));
    protocol_.emplace(*store_);
  }

  void say(const std::string& json) { protocol_->receive(json, now_); }
  void open(std::uint64_t credit, const std::string& more = "") {
    say(R"({"type":"open","mesh":"noise","credit":)" + std::to_string(credit) + more + "}");
  }
  std::string text() {
    const auto out = protocol_->next();
    if (!out || !std::holds_alternative<std::string>(*out)) return "(no text)";
    return std::get<std::string>(*out);
  }
  std::string errorCode() {
    const auto message = parseServerMessage(text());
    return message && std::holds_alternative<ErrorMessage>(*message) ? std::get<ErrorMessage>(*message).code : "(no error)";
  }
  OpenedMessage opened() {
    const auto message = parseServerMessage(text());
    return message && std::holds_alternative<OpenedMessage>(*message) ? std::get<OpenedMessage>(*message) : OpenedMessage{};
  }
  std::optional<OutgoingFrame> frame() {
    const auto out = protocol_->next();
    if (!out || !std::holds_alternative<OutgoingFrame>(*out)) return std::nullopt;
    return std::get<OutgoingFrame>(*out);
  }
  bool silent() { return !protocol_->next(); }
  bool closes() {
    const auto out = protocol_->next();
    return out && std::holds_alternative<CloseCode>(*out) && std::get<CloseCode>(*out) == CloseCode::kPolicy;
  }
  const ServedMesh& mesh() { return *store_->find("noise"); }

  test::TempFolder folder_;
  std::optional<MeshStore> store_;
  std::optional<StreamProtocol> protocol_;
  StreamProtocol::Clock::time_point now_ = StreamProtocol::Clock::now();
};

TEST_F(StreamProtocolTest, saysNothingUnasked) { EXPECT_TRUE(silent()); }

TEST_F(StreamProtocolTest, everythingAskedForIsTheFileItself) {
  open(kMaxCredit, R"(,"fields":["velocity","density","density"])");
  const OpenedMessage answer = opened();
  EXPECT_EQ(answer.stream, 1u);
  EXPECT_EQ(answer.digest, mesh().log.digest());
  EXPECT_EQ(answer.bytes, mesh().log.bytes().size());
  EXPECT_EQ(answer.planned, mesh().log.bytes().size());
  Bytes all;
  for (std::optional<OutgoingFrame> f; all.size() < answer.planned && (f = frame());) {
    EXPECT_EQ(f->header.stream, 1u);
    EXPECT_EQ(f->header.size, f->payload.size());
    all.insert(all.end(), f->payload.begin(), f->payload.end());
  }
  EXPECT_TRUE(std::ranges::equal(all, mesh().log.bytes()));
  EXPECT_EQ(text(), R"({"stream":1,"type":"done"})");
  EXPECT_TRUE(silent());
}

TEST_F(StreamProtocolTest, noFrameIsSentWithoutCredit) {
  open(0);
  EXPECT_EQ(opened().stream, 1u);
  EXPECT_TRUE(silent());
  say(R"({"type":"credit","bytes":1})");
  const auto head = frame();
  ASSERT_TRUE(head);
  EXPECT_EQ(head->header.firstPart, FrameHeader::kHead);
  EXPECT_TRUE(silent());  // below zero now
  say(R"({"type":"credit","bytes":)" + std::to_string(head->header.size - 1) + "}");
  EXPECT_TRUE(silent());  // exactly zero is not positive
  say(R"({"type":"credit","bytes":1})");
  EXPECT_TRUE(frame());
}

TEST_F(StreamProtocolTest, doneNeedsNoCredit) {
  open(1, R"(,"have":{"chunks":5})");
  EXPECT_EQ(opened().stream, 1u);
  ASSERT_TRUE(frame());
  EXPECT_EQ(text(), R"({"stream":1,"type":"done"})");
}

TEST_F(StreamProtocolTest, aClientThatHasEverythingIsDoneAtOnce) {
  open(0, R"(,"have":{"chunks":6})");
  EXPECT_EQ(opened().planned, 0u);
  EXPECT_EQ(text(), R"({"stream":1,"type":"done"})");
}

TEST_F(StreamProtocolTest, aSecondOpenSupersedesTheFirstAndItsCredit) {
  open(kMaxCredit);
  EXPECT_EQ(opened().stream, 1u);
  ASSERT_TRUE(frame());
  open(0);
  EXPECT_EQ(opened().stream, 2u);
  EXPECT_TRUE(silent());
  say(R"({"type":"credit","bytes":1})");
  const auto first = frame();
  ASSERT_TRUE(first);
  EXPECT_EQ(first->header.stream, 2u);
  EXPECT_EQ(first->header.firstPart, FrameHeader::kHead);
}

TEST_F(StreamProtocolTest, stopEndsAStreamAndSaysSo) {
  say(R"({"type":"stop"})");
  EXPECT_EQ(text(), R"({"stream":0,"type":"stopped"})");
  open(kMaxCredit);
  EXPECT_EQ(opened().stream, 1u);
  ASSERT_TRUE(frame());
  say(R"({"type":"stop"})");
  EXPECT_EQ(text(), R"({"stream":1,"type":"stopped"})");
  EXPECT_TRUE(silent());
  say(R"({"type":"credit","bytes":1000})");
  EXPECT_TRUE(silent());
}

TEST_F(StreamProtocolTest, whatDoesNotExistIsNamedAndTheSocketStays) {
  say(R"({"type":"open","mesh":"nothing","credit":1})");
  EXPECT_EQ(errorCode(), "not-found");
  open(1, R"(,"fields":["pressure"])");
  EXPECT_EQ(errorCode(), "unknown-field");
  open(1, R"(,"have":{"chunks":1,"fields":{"pressure":1}})");
  EXPECT_EQ(errorCode(), "unknown-field");
  open(1, R"(,"digest":")" + std::string(64, '0') + "\"");
  EXPECT_EQ(errorCode(), "log-changed");
  open(1, R"(,"have":{"chunks":7})");
  EXPECT_EQ(errorCode(), "log-changed");
  EXPECT_TRUE(silent());
  open(1, R"(,"digest":")" + mesh().log.digest() + "\"");
  EXPECT_EQ(opened().stream, 6u);
}

TEST_F(StreamProtocolTest, aRefusedOpenEndsTheStreamBeforeIt) {
  for (const char* refused : {R"({"type":"open","mesh":"nothing","credit":1})", R"({"type":"open","mesh":"noise","fields":["pressure"],"credit":1})",
                              R"({"type":"open","mesh":"noise","have":{"chunks":7},"credit":1})"}) {
    open(kMaxCredit);
    EXPECT_NE(opened().stream, 0u);
    say(refused);
    EXPECT_NE(errorCode(), "(no error)");
    EXPECT_TRUE(silent()) << refused;
  }
}

TEST_F(StreamProtocolTest, whatIsNotUnderstoodClosesAfterAnExplanation) {
  open(kMaxCredit);
  say("hello");
  EXPECT_EQ(opened().stream, 1u);
  EXPECT_EQ(errorCode(), "bad-message");
  EXPECT_TRUE(closes());
  open(1);  // too late
  EXPECT_TRUE(closes());
}

TEST_F(StreamProtocolTest, binaryMessagesAreNotUnderstood) {
  protocol_->receiveBinary();
  EXPECT_EQ(errorCode(), "bad-message");
  EXPECT_TRUE(closes());
}

TEST_F(StreamProtocolTest, messagesBeyondTheRateClose) {
  for (unsigned i = 0; i < limits::kMaxMessagesPerSecond; ++i) say(R"({"type":"credit","bytes":1})");
  EXPECT_TRUE(silent());
  say(R"({"type":"credit","bytes":1})");
  EXPECT_EQ(errorCode(), "too-many-messages");
  EXPECT_TRUE(closes());
}

TEST_F(StreamProtocolTest, theRateIsCountedAnewEverySecond) {
  for (unsigned i = 0; i < 3 * limits::kMaxMessagesPerSecond; ++i) {
    if (i % limits::kMaxMessagesPerSecond == 0) now_ += std::chrono::seconds(1);
    say(R"({"type":"credit","bytes":1})");
  }
  EXPECT_TRUE(silent());
}

TEST_F(StreamProtocolTest, opensBeyondTheirRateClose) {
  for (unsigned i = 0; i < limits::kMaxOpensPerSecond; ++i) {
    open(0);
    EXPECT_EQ(opened().stream, i + 1);
  }
  open(0);
  EXPECT_EQ(errorCode(), "too-many-messages");
  EXPECT_TRUE(closes());
}

TEST_F(StreamProtocolTest, answersThatNobodyReadsDoNotPileUp) {
  for (unsigned i = 0; i <= limits::kMaxQueuedAnswers; ++i) say(R"({"type":"stop"})");
  for (unsigned i = 0; i < limits::kMaxQueuedAnswers; ++i) EXPECT_EQ(text(), R"({"stream":0,"type":"stopped"})");
  EXPECT_EQ(errorCode(), "too-many-messages");
  EXPECT_TRUE(closes());
}

TEST_F(StreamProtocolTest, creditCannotOverflow) {
  open(kMaxCredit);
  EXPECT_EQ(opened().stream, 1u);
  for (int i = 0; i < 1500; ++i) say(R"({"type":"credit","bytes":9007199254740991})");
  EXPECT_TRUE(frame());
}

}  // namespace
}  // namespace qtet
