// Requests to servers that lie, wander or hang. (With a real one: tests/server/routes.)
#include "simplify/remote/http_client.h"

#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "tests/simplify/remote/canned_server.h"

namespace qtet {
namespace {

using namespace std::chrono_literals;
using test::CannedServer;
using Manner = CannedServer::Manner;

/// Time-outs that a test waits for, where the others are longer than any test.
constexpr auto kShort = 200ms;
constexpr HttpPatience kEndless{.connecting = 1h, .moving = 1h, .answering = 1h};

Result<HttpAnswer> get(const std::string& origin, const HttpPatience& patience = kEndless) {
  return exchange({origin, "/"}, {.method = "GET",
                                  .target = "/a?b=c",
                                  .headers = {"Authorization: Bearer secret"},
                                  .patience = patience});
}

Result<HttpAnswer> put(const std::string& origin, std::size_t bytes,
                       const HttpPatience& patience = kEndless) {
  const Bytes body(bytes, 'x');
  return exchange({origin, "/"},
                  {.method = "PUT", .target = "/a", .body = body, .patience = patience});
}

TEST(HttpClient, urlsComeApart) {
  for (const auto& [text, origin, path] : std::vector<std::array<std::string, 3>>{
           {"http://a", "http://a", "/"},
           {"http://a:8080/", "http://a:8080", "/"},
           {"https://a.example/v1/meshes/my%20wing", "https://a.example", "/v1/meshes/my%20wing"},
           {"HTTPS://[::1]:8443/x", "https://[::1]:8443", "/x"}}) {
    const Result<HttpUrl> url = parseHttpUrl(text);
    ASSERT_TRUE(url) << url.error().message;
    EXPECT_EQ(url->origin, origin);
    EXPECT_EQ(url->path, path);
  }
}

TEST(HttpClient, urlsThatAreNoneOrHoldMoreAreRefused) {
  for (const char* text : {"", "nonsense", "ftp://a/", "file:///etc/passwd", "http://",
                           "http://a:b/", "http://a:99999/", "http://me@a/", "http://a/?q",
                           "http://a/#f", "http://a b/", "http://a/\xC3\xA4"}) {
    const Result<HttpUrl> url = parseHttpUrl(text);
    ASSERT_FALSE(url) << text;
    EXPECT_EQ(url.error().code, ErrorCode::kBadValue);
  }
}

TEST(HttpClient, segmentsAreEncodedByteByByte) {
  EXPECT_EQ(encodedSegment("Az09-._~"), "Az09-._~");
  EXPECT_EQ(encodedSegment("a/b c\xC3\xA4%"), "a%2Fb%20c%C3%A4%25");
  EXPECT_EQ(encodedSegment(""), "");
}

TEST(HttpClient, aGetFollowsARedirectionWithoutItsToken) {
  const CannedServer other("HTTP/1.1 200 OK\r\nContent-Length: 2\r\n\r\nhi");
  const CannedServer first(
      "HTTP/1.1 302 Found\r\nContent-Length: 0\r\nLocation: " + other.origin() + "/there\r\n\r\n");
  const Result<HttpAnswer> answer = get(first.origin());
  ASSERT_TRUE(answer) << answer.error().message;
  EXPECT_EQ(answer->status, 200u);
  EXPECT_EQ(answer->body, "hi");
  ASSERT_EQ(first.requests().size(), 1u);
  EXPECT_NE(first.requests()[0].find("Bearer secret"), std::string::npos);
  ASSERT_EQ(other.requests().size(), 1u);
  EXPECT_TRUE(other.requests()[0].starts_with("GET /there HTTP/1.1\r\n"));
  EXPECT_EQ(other.requests()[0].find("secret"), std::string::npos);
}

TEST(HttpClient, aPutFollowsNoRedirectionAndSaysWhereItLeads) {
  const CannedServer other("HTTP/1.1 200 OK\r\nContent-Length: 0\r\n\r\n");
  const CannedServer first(
      "HTTP/1.1 307 Moved\r\nContent-Length: 0\r\nLocation: " + other.origin() + "/there\r\n\r\n");
  const Result<HttpAnswer> answer = put(first.origin(), 10);
  ASSERT_TRUE(answer) << answer.error().message;
  EXPECT_EQ(answer->status, 307u);
  EXPECT_EQ(answer->location, other.origin() + "/there");
  EXPECT_TRUE(other.requests().empty());
}

TEST(HttpClient, redirectionsThatGoRoundEnd) {
  const CannedServer server("HTTP/1.1 302 Found\r\nContent-Length: 0\r\nLocation: /a\r\n\r\n");
  const Result<HttpAnswer> answer = get(server.origin());
  ASSERT_FALSE(answer);
  EXPECT_EQ(answer.error().code, ErrorCode::kBadValue);
}

TEST(HttpClient, aRedirectionToAFileIsNotFollowed) {
  const CannedServer server(
      "HTTP/1.1 302 Found\r\nContent-Length: 0\r\nLocation: file:///etc/passwd\r\n\r\n");
  const Result<HttpAnswer> answer = get(server.origin());
  ASSERT_FALSE(answer);
  EXPECT_EQ(answer.error().code, ErrorCode::kBadValue);
}

TEST(HttpClient, aServerThatDoesNotAnswerIsGivenUp) {
  const CannedServer server("", Manner::kReadsOnly);
  HttpPatience patience = kEndless;
  patience.answering = kShort;
  const Result<HttpAnswer> answer = get(server.origin(), patience);
  ASSERT_FALSE(answer);
  EXPECT_EQ(answer.error().code, ErrorCode::kIo);
  EXPECT_NE(answer.error().message.find("does not answer"), std::string::npos);
}

TEST(HttpClient, aServerThatTakesNothingMoreIsGivenUp) {
  const CannedServer server("", Manner::kMute);
  constexpr std::size_t kMoreThanBuffersHold = 64u << 20;
  HttpPatience patience = kEndless;
  patience.moving = kShort;
  const Result<HttpAnswer> answer = put(server.origin(), kMoreThanBuffersHold, patience);
  ASSERT_FALSE(answer);
  EXPECT_EQ(answer.error().code, ErrorCode::kIo);
  EXPECT_NE(answer.error().message.find("takes nothing"), std::string::npos);
}

TEST(HttpClient, aHandshakeThatHangsIsGivenUp) {
  const CannedServer server("", Manner::kMute);
  HttpPatience patience = kEndless;
  patience.connecting = kShort;
  const Result<HttpAnswer> answer = get("https" + server.origin().substr(4), patience);
  ASSERT_FALSE(answer);
  EXPECT_EQ(answer.error().code, ErrorCode::kIo);
}

TEST(HttpClient, anAnswerThatDoesNotEndIsCutOff) {
  constexpr std::size_t kMuch = 5u << 20;
  const CannedServer server("HTTP/1.1 200 OK\r\n\r\n" + std::string(kMuch, 'x'));
  const Result<HttpAnswer> answer = get(server.origin());
  ASSERT_FALSE(answer);
  EXPECT_EQ(answer.error().code, ErrorCode::kIo);
  EXPECT_NE(answer.error().message.find("does not end"), std::string::npos);
}

TEST(HttpClient, somethingElseThanHttpIsNoAnswer) {
  const CannedServer server("SSH-2.0-OpenSSH_9.2\r\n");
  const Result<HttpAnswer> answer = get(server.origin());
  ASSERT_FALSE(answer);
  EXPECT_EQ(answer.error().code, ErrorCode::kBadValue);
  EXPECT_NE(answer.error().message.find("does not speak HTTP"), std::string::npos);
}

TEST(HttpClient, aRefusalBeforeTheBodyWasSentIsAnAnswer) {
  const CannedServer server("HTTP/1.1 413 Too Large\r\nContent-Length: 2\r\n\r\nno");
  const Result<HttpAnswer> answer = put(server.origin(), 64u << 20);
  ASSERT_TRUE(answer) << answer.error().message;
  EXPECT_EQ(answer->status, 413u);
  EXPECT_EQ(answer->body, "no");
}

TEST(HttpClient, nobodyThereIsAnError) {
  std::string gone;
  {
    const CannedServer server("");
    gone = server.origin();
  }
  const Result<HttpAnswer> answer = get(gone);
  ASSERT_FALSE(answer);
  EXPECT_EQ(answer.error().code, ErrorCode::kIo);
  EXPECT_NE(answer.error().message.find(gone), std::string::npos) << answer.error().message;
}

}  // namespace
}  // namespace qtet
