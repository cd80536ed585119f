#include "server/stream/stream_protocol.h"

#include <gtest/gtest.h>

#include <map>
#include <ranges>

#include "server/stream/stream_limits.h"
#include "tests/server/store/synthetic_log.h"

namespace qtet {
namespace {

class StreamProtocolTest : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_.write("noise.qtet", test::makeLog({.chunks = 6}));
    folder_.write("known.qtet", test::makeLog({.chunks = 16, .seed = 3, .errors = true}));
    folder_.write("series.qtet",
                  test::makeLog({.chunks = 3, .fields = {"T@0", "velocity", "T@1", "T@2"}}));
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
    return message && std::holds_alternative<ErrorMessage>(*message)
               ? std::get<ErrorMessage>(*message).code
               : "(no error)";
  }
  OpenedMessage opened() {
    const auto message = parseServerMessage(text());
    return message && std::holds_alternative<OpenedMessage>(*message)
               ? std::get<OpenedMessage>(*message)
               : OpenedMessage{};
  }
  std::optional<OutgoingFrame> frame() {
    const auto out = protocol_->next();
    if (!out || !std::holds_alternative<OutgoingFrame>(*out)) return std::nullopt;
    return std::get<OutgoingFrame>(*out);
  }
  PlannedMessage planned() {
    const auto message = parseServerMessage(text());
    return message && std::holds_alternative<PlannedMessage>(*message)
               ? std::get<PlannedMessage>(*message)
               : PlannedMessage{};
  }
  void openKnown(const std::string& more) {
    say(R"({"type":"open","mesh":"known","fields":["density"],"credit":9007199254740991)" + more +
        "}");
  }
  /// Chunk and first part of all frames but the head up to the next word.
  std::vector<std::pair<std::uint32_t, std::uint32_t>> places() {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> out;
    for (std::optional<Outgoing> o;
         (o = protocol_->next()) && std::holds_alternative<OutgoingFrame>(*o);) {
      const FrameHeader& header = std::get<OutgoingFrame>(*o).header;
      if (header.firstPart != FrameHeader::kHead) out.emplace_back(header.chunk, header.firstPart);
    }
    return out;
  }
  std::vector<std::uint32_t> chunks() {
    std::vector<std::uint32_t> out;
    for (const auto& [chunk, part] : places()) out.push_back(chunk);
    return out;
  }
  static Bytes encoded(const OutgoingFrame& frame) {
    const auto head = frame.header.encode();
    Bytes out(head.begin(), head.end());
    out.insert(out.end(), frame.payload.begin(), frame.payload.end());
    return out;
  }
  bool silent() { return !protocol_->next(); }
  bool closes() {
    const auto out = protocol_->next();
    return out && std::holds_alternative<CloseCode>(*out) &&
           std::get<CloseCode>(*out) == CloseCode::kPolicy;
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

/// Joins pieces as a client does, by chunk and first part.
struct Joined {
  std::map<std::pair<std::uint32_t, std::uint32_t>, Bytes> begun, whole;
  void take(const OutgoingFrame& frame) {
    const std::pair at{frame.header.chunk, std::uint32_t{frame.header.firstPart}};
    Bytes& bytes = begun[at];
    bytes.insert(bytes.end(), frame.payload.begin(), frame.payload.end());
    if (frame.header.parts == FrameHeader::kPiece && at.second != FrameHeader::kHead) return;
    whole[at] = std::move(bytes);
    begun.erase(at);
  }
};

TEST_F(StreamProtocolTest, aSlowLineGetsBlocksInPiecesThatMakeTheFile) {
  open(kMaxCredit, R"(,"fields":["velocity","density"])");
  const std::uint64_t planned = opened().planned;
  constexpr std::size_t kPiece = 100;
  Joined joined;
  std::uint64_t sent = 0;
  while (const auto out = protocol_->next(kPiece, kPiece)) {
    const auto* frame = std::get_if<OutgoingFrame>(&*out);
    if (!frame) break;
    sent += frame->payload.size();
    EXPECT_GT(frame->payload.size(), 0u);
    const FrameHeader& header = frame->header;
    if (header.firstPart == FrameHeader::kHead) continue;
    EXPECT_LE(frame->payload.size(), kPiece);
    EXPECT_TRUE(FrameHeader::parse(encoded(*frame)));
    joined.take(*frame);
  }
  EXPECT_EQ(sent, planned);
  EXPECT_TRUE(joined.begun.empty());
  const LogIndex& index = mesh().log.index();
  std::size_t large = 0;
  for (const auto& [at, bytes] : joined.whole) {
    const BlockEntry& block = index.block(at.first, at.second);
    EXPECT_TRUE(std::ranges::equal(bytes | std::views::take(block.size),
                                   mesh().log.bytes().subspan(block.offset, block.size)));
    large += block.size > kPiece;
  }
  EXPECT_GT(large, 6u) << "else no piece was tried";
}

TEST_F(StreamProtocolTest, aBlockThatWasBegunGoesOnWhereItStoppedWhenItsTurnComesAgain) {
  openKnown("");
  (void)opened();
  (void)frame();  // the head
  const auto piece = [&] { return std::get<OutgoingFrame>(*protocol_->next(10, 10)); };
  const OutgoingFrame first = piece();
  ASSERT_EQ(first.header.parts, FrameHeader::kPiece);
  say(R"({"type":"target","target":{"level":99}})");
  const std::uint64_t before = planned().planned;
  const OutgoingFrame second = piece();
  EXPECT_EQ(second.header.chunk, first.header.chunk);
  EXPECT_EQ(second.header.firstPart, first.header.firstPart);
  EXPECT_EQ(second.payload.data(), first.payload.data() + 10);
  say(R"({"type":"target","target":{"level":99}})");
  EXPECT_EQ(planned().planned, before - 10);
  say(R"({"type":"resume","have":{}})");
  EXPECT_EQ(piece().payload.data(), first.payload.data()) << "have says that nothing is there";
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

TEST_F(StreamProtocolTest, aFrameHasNoMoreThanThereIsRoomForOrOneBlock) {
  open(kMaxCredit, R"(,"fields":["velocity","density"])");
  EXPECT_EQ(opened().stream, 1u);
  EXPECT_FALSE(protocol_->next(0));
  EXPECT_TRUE(protocol_->hasFrame());
  Bytes all;
  std::size_t blocks = 0;
  while (protocol_->hasFrame()) {
    const auto out = protocol_->next(1);
    ASSERT_TRUE(out && std::holds_alternative<OutgoingFrame>(*out));
    const auto& frame = std::get<OutgoingFrame>(*out);
    if (frame.header.firstPart != FrameHeader::kHead) {
      EXPECT_TRUE(frame.header.parts == 1 || frame.payload.size() <= 1) << "blocks may be empty";
      ++blocks;
    }
    all.insert(all.end(), frame.payload.begin(), frame.payload.end());
  }
  EXPECT_GT(blocks, mesh().log.index().chunks.size());
  EXPECT_TRUE(std::ranges::equal(all, mesh().log.bytes()));
  EXPECT_EQ(text(), R"({"stream":1,"type":"done"})");
}

TEST_F(StreamProtocolTest, withoutRoomAnswersStillCome) {
  open(kMaxCredit);
  EXPECT_EQ(opened().stream, 1u);
  say(R"({"type":"target","target":{"level":2}})");
  EXPECT_GT(planned().planned, 0u);
  EXPECT_FALSE(protocol_->next(0));
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

TEST_F(StreamProtocolTest, cancelIsStopUnderItsOtherName) {
  open(kMaxCredit);
  EXPECT_EQ(opened().stream, 1u);
  say(R"({"type":"cancel"})");
  EXPECT_EQ(text(), R"({"stream":1,"type":"stopped"})");
  EXPECT_TRUE(silent());
}

TEST_F(StreamProtocolTest, targetsThatWaitAreAnsweredOnce) {
  openKnown("");
  EXPECT_EQ(opened().stream, 1u);
  for (int level = 3; level > 0; --level)
    say(R"({"type":"target","target":{"level":)" + std::to_string(level) + "}}");
  EXPECT_EQ(planned().stream, 1u);
  EXPECT_EQ(chunks(), (std::vector<std::uint32_t>{0, 1}));
  EXPECT_TRUE(silent());
}

TEST_F(StreamProtocolTest, aTargetEndsTheStreamAndALaterOneGoesOn) {
  openKnown(R"(,"target":{"level":1})");
  EXPECT_EQ(opened().stream, 1u);
  EXPECT_EQ(chunks(), (std::vector<std::uint32_t>{0, 1}));
  EXPECT_TRUE(silent());
  say(R"({"type":"target","target":{"level":3}})");
  EXPECT_GT(planned().planned, 0u);
  EXPECT_EQ(chunks(), (std::vector<std::uint32_t>{2, 3}));
  say(R"({"type":"target","target":{"level":0}})");
  EXPECT_EQ(planned().planned, 0u);
  EXPECT_EQ(text(), R"({"stream":1,"type":"done"})");
  say(R"({"type":"target","target":null})");
  EXPECT_GT(planned().planned, 0u);
  EXPECT_EQ(chunks().size(), 12u);
}

TEST_F(StreamProtocolTest, aTargetOfAnUnknownFieldChangesNothing) {
  openKnown(R"(,"target":{"level":1})");
  EXPECT_EQ(opened().stream, 1u);
  say(R"({"type":"target","target":{"error":0.1,"field":"pressure"}})");
  EXPECT_EQ(errorCode(), "unknown-field");
  EXPECT_EQ(chunks(), (std::vector<std::uint32_t>{0, 1}));
  openKnown(R"(,"target":{"error":0.1,"field":"pressure"})");
  EXPECT_EQ(errorCode(), "unknown-field");
  EXPECT_TRUE(silent());
}

TEST_F(StreamProtocolTest, pauseKeepsTheStreamAndItsCredit) {
  open(kMaxCredit);
  EXPECT_EQ(opened().stream, 1u);
  ASSERT_TRUE(frame());
  say(R"({"type":"pause"})");
  EXPECT_TRUE(silent());
  say(R"({"type":"target","target":null})");
  EXPECT_GT(planned().planned, 0u);
  EXPECT_TRUE(silent());
  say(R"({"type":"resume"})");
  EXPECT_EQ(frame()->header.chunk, 0u);
  EXPECT_EQ(frame()->header.chunk, 1u);
}

TEST_F(StreamProtocolTest, resumeMaySayAnewWhatIsThere) {
  openKnown("");
  EXPECT_EQ(opened().stream, 1u);
  say(R"({"type":"pause"})");
  say(R"({"type":"resume","have":{"chunks":15,"fields":{"density":14}}})");
  EXPECT_EQ(frame()->header.firstPart, FrameHeader::kHead) << "it was not sent before";
  EXPECT_EQ(chunks(), (std::vector<std::uint32_t>{14, 15}));
  say(R"({"type":"resume","have":{"chunks":17}})");
  EXPECT_EQ(errorCode(), "log-changed");
  EXPECT_TRUE(silent()) << "and nothing is sent again";
}

TEST_F(StreamProtocolTest, requestsWithoutAStreamAreIgnored) {
  for (const char* request :
       {R"({"type":"target","target":null})", R"({"type":"pause"})", R"({"type":"resume"})"})
    say(request);
  EXPECT_TRUE(silent());
}

TEST_F(StreamProtocolTest, targetsBeyondTheirRateClose) {
  open(0);
  EXPECT_EQ(opened().stream, 1u);
  for (unsigned i = 0; i < limits::kMaxChangesPerSecond; ++i)
    say(R"({"type":"target","target":null})");
  EXPECT_EQ(planned().stream, 1u);
  say(R"({"type":"target","target":null})");
  EXPECT_EQ(errorCode(), "too-many-messages");
  EXPECT_TRUE(closes());
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

TEST_F(StreamProtocolTest, instantsComeInTheOrderOfTheirTimes) {
  const auto openSeries = [&](const std::string& more) {
    say(R"({"type":"open","mesh":"series","fields":["T"],"credit":9007199254740991)" + more + "}");
  };
  openSeries("");
  EXPECT_EQ(errorCode(), "unknown-field");
  openSeries(R"(,"time":{"at":1,"ahead":1})");
  EXPECT_GT(opened().planned, 0u);
  using Places = std::vector<std::pair<std::uint32_t, std::uint32_t>>;
  const std::uint32_t second = kFirstFieldPart + 2, third = kFirstFieldPart + 3;
  EXPECT_EQ(places(), (Places{{0, 0},
                              {0, second},
                              {1, 0},
                              {1, second},
                              {2, 0},
                              {2, second},
                              {0, third},
                              {1, third},
                              {2, third}}));
  openSeries(R"(,"time":{"at":1,"ahead":1,"first":"time"})");
  EXPECT_GT(opened().planned, 0u);
  EXPECT_EQ(places(), (Places{{0, 0}, {0, second}, {1, 0}, {1, second}, {2, 0}, {2, second}}));
  say(R"({"type":"resume","have":{"chunks":3,"fields":{"T@1":2}}})");
  EXPECT_EQ(places(), (Places{{0, third}, {1, third}, {2, second}}));
}

TEST_F(StreamProtocolTest, aRefusedOpenEndsTheStreamBeforeIt) {
  for (const char* refused : {R"({"type":"open","mesh":"nothing","credit":1})",
                              R"({"type":"open","mesh":"noise","fields":["pressure"],"credit":1})",
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
  for (unsigned i = 0; i < limits::kMaxMessagesPerSecond; ++i)
    say(R"({"type":"credit","bytes":1})");
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
  for (unsigned i = 0; i < limits::kMaxQueuedAnswers; ++i)
    EXPECT_EQ(text(), R"({"stream":0,"type":"stopped"})");
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
