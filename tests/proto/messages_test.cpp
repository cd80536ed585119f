#include "proto/messages.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "proto/limits.h"

namespace qtet {
namespace {

OpenMessage sampleOpen() {
  return {.mesh = "comb",
          .digest = std::string(64, 'a'),
          .fields = {"density", "velocity"},
          .time = StreamTime{0.5, 8, StreamTime::First::kTime},
          .have = {7, {{"density", 3}, {"velocity", 7}}},
          .target = FieldErrorTarget{0.01, "density"},
          .credit = 1 << 20};
}

ErrorCode refusal(const std::string& json) {
  const Result<ClientMessage> message = parseClientMessage(json);
  if (message) ADD_FAILURE() << "accepted: " << json;
  return message ? ErrorCode::kIo : message.error().code;
}

TEST(Messages, openIsReadBack) {
  const Result<ClientMessage> read = parseClientMessage(toJson(ClientMessage(sampleOpen())));
  ASSERT_TRUE(read) << read.error().message;
  const auto& open = std::get<OpenMessage>(*read);
  EXPECT_EQ(open.mesh, "comb");
  EXPECT_EQ(open.digest, std::string(64, 'a'));
  EXPECT_EQ(open.fields, (std::vector<std::string>{"density", "velocity"}));
  ASSERT_TRUE(open.time);
  EXPECT_EQ(open.time->at, 0.5);
  EXPECT_EQ(open.time->ahead, 8u);
  EXPECT_EQ(open.time->first, StreamTime::First::kTime);
  EXPECT_EQ(open.have.chunks, 7u);
  ASSERT_EQ(open.have.fields.size(), 2u);
  EXPECT_EQ(open.have.fields[0].first, "density");
  EXPECT_EQ(open.have.fields[0].second, 3u);
  EXPECT_EQ(std::get<FieldErrorTarget>(open.target).field, "density");
  EXPECT_EQ(std::get<FieldErrorTarget>(open.target).error, 0.01);
  EXPECT_EQ(open.credit, 1u << 20);
}

TEST(Messages, creditAndStopAreUnderstood) {
  const auto credit = parseClientMessage(R"({"type":"credit","bytes":12345})");
  ASSERT_TRUE(credit);
  EXPECT_EQ(std::get<CreditMessage>(*credit).bytes, 12345u);
  const auto stop = parseClientMessage(R"({"type":"stop"})");
  ASSERT_TRUE(stop);
  EXPECT_TRUE(std::holds_alternative<CancelMessage>(*stop));
}

TEST(Messages, requestsAreReadBack) {
  const auto again = [](const std::string& json) {
    const auto message = parseClientMessage(json);
    return message ? toJson(*message) : message.error().message;
  };
  for (const std::string json :
       {R"({"target":{"level":3},"type":"target"})",
        R"({"target":{"bytes":5000000000},"type":"target"})",
        R"({"target":{"tetrahedra":9},"type":"target"})",
        R"({"target":{"error":0.5,"field":"a"},"type":"target"})",
        R"({"target":{"boundaryError":0.25},"type":"target"})",
        R"({"target":null,"type":"target"})", R"({"type":"pause"})", R"({"type":"resume"})",
        R"({"have":{"chunks":1,"fields":{"a":1}},"type":"resume"})", R"({"type":"cancel"})"})
    EXPECT_EQ(again(json), json);
}

/// At the last legal nesting a message is only strange, past it it is refused before anything is
/// built of it.
TEST(Messages, deepNestingIsRefusedUnread) {
  const auto nested = [](int depth) {
    return R"({"type":"stop","why":)" + std::string(static_cast<std::size_t>(depth), '[') +
           std::string(static_cast<std::size_t>(depth), ']') + "}";
  };
  EXPECT_TRUE(parseClientMessage(nested(31)));
  EXPECT_EQ(refusal(nested(32)), ErrorCode::kBadValue);
  EXPECT_EQ(refusal(nested(30000)), ErrorCode::kBadValue);
  EXPECT_TRUE(
      parseClientMessage(R"({"type":"stop","why":"\"[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[["})"));
}

TEST(Messages, membersOfLaterVersionsAreIgnored) {
  EXPECT_TRUE(parseClientMessage(R"({"type":"stop","why":"lunch"})"));
}

TEST(Messages, wrongShapesAreBadValues) {
  for (const char* json :
       {"",
        "{",
        "null",
        "7",
        "[]",
        "\"stop\"",
        "{}",
        R"({"type":7})",
        R"({"type":"jump"})",
        R"({"type":"credit"})",
        R"({"type":"credit","bytes":-1})",
        R"({"type":"credit","bytes":1.5})",
        R"({"type":"credit","bytes":"1"})",
        R"({"type":"credit","bytes":9007199254740992})",
        R"({"type":"open","credit":1})",
        R"({"type":"open","mesh":"a"})",
        R"({"type":"open","mesh":"","credit":1})",
        R"({"type":"open","mesh":["a"],"credit":1})",
        R"({"type":"open","mesh":"a","fields":"x","credit":1})",
        R"({"type":"open","mesh":"a","fields":[1],"credit":1})",
        R"({"type":"open","mesh":"a","have":5,"credit":1})",
        R"({"type":"open","mesh":"a","have":{"chunks":-1},"credit":1})",
        R"({"type":"open","mesh":"a","have":{"chunks":1048577},"credit":1})",
        R"({"type":"open","mesh":"a","have":{"chunks":1,"fields":{"x":2}},"credit":1})",
        R"({"type":"open","mesh":"a","have":{"fields":[]},"credit":1})",
        R"({"type":"open","mesh":"a","digest":"abc","credit":1})",
        R"({"type":"open","mesh":"a","time":1,"credit":1})",
        R"({"type":"open","mesh":"a","time":{"ahead":1},"credit":1})",
        R"({"type":"open","mesh":"a","time":{"at":"0"},"credit":1})",
        R"({"type":"open","mesh":"a","time":{"at":0,"ahead":-1},"credit":1})",
        R"({"type":"open","mesh":"a","time":{"at":0,"first":"both"},"credit":1})",
        R"({"type":"view","view":null})",
        R"({"type":"target"})",
        R"({"type":"target","target":{}})",
        R"({"type":"target","target":{"level":1,"bytes":2}})",
        R"({"type":"target","target":{"error":0.1}})",
        R"({"type":"target","target":{"boundaryError":-1}})",
        R"({"type":"stop"} {"type":"stop"})",
        "{\"type\":\"stop\xFF\"}"})
    EXPECT_EQ(refusal(json), ErrorCode::kBadValue) << json;
}

TEST(Messages, aRefusalNamesThePlace) {
  const auto result =
      parseClientMessage(R"({"type":"open","mesh":"a","fields":["x",7],"credit":1})");
  ASSERT_FALSE(result);
  EXPECT_NE(result.error().message.find("/fields/1"), std::string::npos) << result.error().message;
}

TEST(Messages, whatIsTooLongIsRefusedUnread) {
  const std::string stop = R"({"type":"stop"})";
  EXPECT_TRUE(parseClientMessage(stop + std::string(kMaxMessageBytes - stop.size(), ' ')));
  EXPECT_EQ(refusal(stop + std::string(kMaxMessageBytes - stop.size() + 1, ' ')),
            ErrorCode::kLimitExceeded);
}

TEST(Messages, oneFieldTooManyIsRefused) {
  OpenMessage open = sampleOpen();
  open.fields.assign(kMaxRequestFields, "f");
  EXPECT_TRUE(parseClientMessage(toJson(ClientMessage(open))));
  open.fields.push_back("f");
  EXPECT_EQ(refusal(toJson(ClientMessage(open))), ErrorCode::kBadValue);
}

TEST(Messages, oneInstantAheadTooManyIsRefused) {
  OpenMessage open = sampleOpen();
  for (const std::uint32_t ahead : {kMaxAhead - 1, kMaxAhead}) {
    open.time->ahead = ahead;
    EXPECT_TRUE(parseClientMessage(toJson(ClientMessage(open))));
  }
  open.time->ahead = kMaxAhead + 1;
  EXPECT_EQ(refusal(toJson(ClientMessage(open))), ErrorCode::kBadValue);
}

TEST(Messages, everyTruncationIsRefused) {
  const std::string whole = toJson(ClientMessage(sampleOpen()));
  for (std::size_t n = 0; n < whole.size(); ++n)
    EXPECT_FALSE(parseClientMessage(whole.substr(0, n))) << n;
}

TEST(Messages, theServersWordsAreReadBack) {
  const auto opened =
      parseServerMessage(toJson(OpenedMessage{3, "comb", std::string(64, '0'), 5000000000ull, 77}));
  ASSERT_TRUE(opened) << opened.error().message;
  EXPECT_EQ(std::get<OpenedMessage>(*opened).bytes, 5000000000ull);
  EXPECT_EQ(std::get<OpenedMessage>(*opened).stream, 3u);
  EXPECT_EQ(std::get<OpenedMessage>(*opened).planned, 77u);
  const auto planned = parseServerMessage(toJson(PlannedMessage{3, 5000000000ull}));
  ASSERT_TRUE(planned);
  EXPECT_EQ(std::get<PlannedMessage>(*planned).planned, 5000000000ull);
  EXPECT_EQ(std::get<DoneMessage>(*parseServerMessage(toJson(DoneMessage{4}))).stream, 4u);
  EXPECT_EQ(std::get<StoppedMessage>(*parseServerMessage(toJson(StoppedMessage{5}))).stream, 5u);
  EXPECT_EQ(std::get<ErrorMessage>(
                *parseServerMessage(toJson(ErrorMessage{kNotFound, "no \"such\" mesh"})))
                .detail,
            "no \"such\" mesh");
  EXPECT_FALSE(parseServerMessage(R"({"type":"hello"})"));
}

TEST(FrameHeader, itsSixteenBytesStandAsTheDocumentDrawsThem) {
  const FrameHeader header{0x04030201, 0x08070605, 0x0A09, 0x0C0B, 0x100F0E0D};
  const auto bytes = header.encode();
  for (std::size_t i = 0; i < bytes.size(); ++i) EXPECT_EQ(bytes[i], i + 1);
}

Bytes frame(const FrameHeader& header, std::size_t payload) {
  Bytes out(FrameHeader::kBytes + payload, 0x55);
  std::ranges::copy(header.encode(), out.begin());
  return out;
}

TEST(FrameHeader, aFrameIsReadBackAndEveryTruncationIsRefused) {
  const FrameHeader header{1, 2, 1, 3, 20};
  const Bytes whole = frame(header, 20);
  const Result<FrameHeader> read = FrameHeader::parse(whole);
  ASSERT_TRUE(read);
  EXPECT_EQ(*read, header);
  for (std::size_t n = 0; n < whole.size(); ++n) {
    const Result<FrameHeader> cut = FrameHeader::parse(ByteView(whole).first(n));
    ASSERT_FALSE(cut) << n;
    EXPECT_EQ(cut.error().code,
              n < FrameHeader::kBytes ? ErrorCode::kTruncated : ErrorCode::kBadValue);
  }
}

TEST(FrameHeader, contradictionsAreRefused) {
  EXPECT_TRUE(FrameHeader::parse(frame({1, 0, FrameHeader::kHead, 0, 5}, 5)));
  EXPECT_TRUE(FrameHeader::parse(frame({1, 0, 0, 1, 0}, 0)));
  EXPECT_FALSE(FrameHeader::parse(frame({1, 0, 0, 1, 5}, 6)));
  EXPECT_TRUE(FrameHeader::parse(frame({1, 0, 0, FrameHeader::kPiece, 1}, 1)));
  constexpr std::size_t kChunkAt = 4, kPartsAt = 10;
  const auto changed = [](Bytes bytes, std::size_t at, std::uint8_t to) {
    bytes[at] = to;
    return bytes;
  };
  const Bytes block = frame({1, 0, 0, 1, 0}, 0), head = frame({1, 0, FrameHeader::kHead, 0, 5}, 5);
  EXPECT_FALSE(FrameHeader::parse(changed(block, kPartsAt, FrameHeader::kPiece)));
  EXPECT_FALSE(FrameHeader::parse(changed(head, kChunkAt, 1)));
  EXPECT_FALSE(FrameHeader::parse(changed(head, kPartsAt, 1)));
}

}  // namespace
}  // namespace qtet
