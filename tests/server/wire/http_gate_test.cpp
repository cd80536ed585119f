#include "server/wire/http_gate.h"

#include <gtest/gtest.h>

#include <string>

#include "server/wire/http_limits.h"

namespace qtet {
namespace {

using GateVerdict = HttpGate::Verdict;

GateVerdict lookAtOnce(const std::string& bytes) { return HttpGate().look(bytes); }

GateVerdict lookByteByByte(const std::string& bytes) {
  HttpGate gate;
  for (std::size_t n = 1; n <= bytes.size(); ++n)
    if (const GateVerdict verdict = gate.look(std::string_view(bytes).substr(0, n));
        verdict != GateVerdict::kMore)
      return verdict;
  return GateVerdict::kMore;
}

TEST(HttpGate, aSoundHeadEndsAtItsEmptyLine) {
  const std::string head = "GET / HTTP/1.1\r\nHost: a\r\nX: \xc3\xa4\tb\r\n\r\n";
  HttpGate gate;
  EXPECT_EQ(gate.look(head + "GET /next"), GateVerdict::kComplete);
  EXPECT_EQ(gate.headBytes(), head.size());
  EXPECT_EQ(lookByteByByte(head), GateVerdict::kComplete);
  for (std::size_t n = 0; n < head.size(); ++n)
    EXPECT_EQ(lookAtOnce(head.substr(0, n)), GateVerdict::kMore) << n;
}

TEST(HttpGate, whatAProxyMayReadInAnotherWayIsBroken) {
  for (const std::string& bytes :
       {std::string("GET / HTTP/1.1\nHost: a\n\n"),
        std::string("GET / HTTP/1.1\r\nX: 1\r\n 2\r\n\r\n"),
        std::string("GET / HTTP/1.1\r\nX: 1\r\n\t2\r\n\r\n"),
        std::string("GET / HTTP/1.1\r\n Host: a\r\n\r\n"),
        std::string("GET / HTTP/1.1\r\nX: 1\r2\r\n\r\n"),
        std::string("GET / HTTP/1.1\r\nX: 1\n\r\n\r\n"),
        std::string("GET / HTTP/1.1\r\nX: 1\0002\r\n\r\n", 26),
        std::string("GET / HTTP/1.1\r\nX: \x0b\r\n\r\n"),
        std::string("GET / HTTP/1.1\r\nX: \x7f\r\n\r\n"), std::string("\x16\x03\x01\x02"),
        std::string(" GET / HTTP/1.1\r\n\r\n"), std::string("\r\n\r\n")}) {
    EXPECT_EQ(lookAtOnce(bytes), GateVerdict::kBroken) << bytes;
    EXPECT_EQ(lookByteByByte(bytes), GateVerdict::kBroken) << bytes;
  }
}

TEST(HttpGate, thereAreAsManyLinesAsTheLimitAllows) {
  const auto head = [](std::size_t lines) {
    std::string out = "GET / HTTP/1.1\r\n";
    for (std::size_t i = 1; i < lines; ++i) out += "X: 1\r\n";
    return out + "\r\n";
  };
  EXPECT_EQ(lookAtOnce(head(limits::kMaxHeaderLines)), GateVerdict::kComplete);
  EXPECT_EQ(lookAtOnce(head(limits::kMaxHeaderLines + 1)), GateVerdict::kTooLong);
}

TEST(HttpGate, emptyLinesBeforeARequestAreFew) {
  EXPECT_EQ(emptyLinesBefore("GET /"), 0u);
  EXPECT_EQ(emptyLinesBefore("\r\nGET /"), 2u);
  EXPECT_EQ(emptyLinesBefore("\r\n\r\n\r\n\r\n"), 4u);
  EXPECT_EQ(emptyLinesBefore("\r"), 0u);
}

}  // namespace
}  // namespace qtet
