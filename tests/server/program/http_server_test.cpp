// HTTP over a real socket: what the router's tests cannot see.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

#include "server/store/store_limits.h"
#include "server/wire/http_limits.h"
#include "tests/server/program/loopback.h"
#include "tests/server/program/served_folder.h"

namespace qtet {
namespace {

using test::HttpResponse;
using test::RawClient;

class HttpServerTest : public ::testing::Test {
 protected:
  test::ServedFolder folder_;
  test::RunningServer server_{folder_.store(), folder_.viewer(), {.threads = 2}};
};

TEST_F(HttpServerTest, theWholeLogArrivesAsItLiesOnDisk) {
  RawClient client(server_.port());
  const HttpResponse response = client.get(folder_.log());
  EXPECT_EQ(response.status, 200u);
  EXPECT_EQ(response.body, folder_.file());
  EXPECT_FALSE(response.header("date").empty());
}

TEST_F(HttpServerTest, rangesOnOneConnectionMakeTheWholeFile) {
  RawClient client(server_.port());
  const std::string file = folder_.file();
  std::string all;
  while (all.size() < file.size()) {
    const std::size_t last = std::min(all.size() + 7777, file.size()) - 1;
    const HttpResponse part =
        client.get(folder_.log(), "Range: bytes=" + std::to_string(all.size()) + "-" +
                                      std::to_string(last) + "\r\n");
    ASSERT_EQ(part.status, 206u);
    all += part.body;
  }
  EXPECT_EQ(all, file);
}

TEST_F(HttpServerTest, severalRangesAreAnsweredByTheWhole) {
  RawClient client(server_.port());
  const HttpResponse response = client.get(folder_.log(), "Range: bytes=0-1,4-5\r\n");
  EXPECT_EQ(response.status, 200u);
  EXPECT_EQ(response.body, folder_.file());
}

TEST_F(HttpServerTest, headHasTheLengthAndNoBody) {
  RawClient client(server_.port());
  client.send("HEAD " + folder_.log() + " HTTP/1.1\r\nHost: a\r\n\r\n");
  const HttpResponse head = client.receive(true);
  EXPECT_EQ(head.status, 200u);
  EXPECT_EQ(head.header("content-length"), std::to_string(folder_.file().size()));
  EXPECT_EQ(client.get("/v1/meshes").status, 200u) << "nothing of a body may lie in between";
}

TEST_F(HttpServerTest, pipelinedRequestsAreAnsweredInOrder) {
  RawClient client(server_.port());
  std::string requests;
  for (const char* target : {"/v1/meshes", "/nothing", "/v1/meshes/noise", "/"})
    requests += "GET " + std::string(target) + " HTTP/1.1\r\nHost: a\r\n\r\n";
  client.send(requests);
  EXPECT_EQ(client.receive().status, 200u);
  EXPECT_EQ(client.receive().status, 404u);
  EXPECT_NE(client.receive().body.find("manifest"), std::string::npos);
  EXPECT_NE(client.receive().body.find("<title>viewer"), std::string::npos);
}

TEST_F(HttpServerTest, aRequestMayComeByteByByte) {
  RawClient client(server_.port());
  for (const char c : std::string("GET /v1/meshes HTTP/1.1\r\nHost: a\r\n\r\n"))
    ASSERT_TRUE(client.send({&c, 1}));
  EXPECT_EQ(client.receive().status, 200u);
}

TEST_F(HttpServerTest, aRequestCutAtEveryByteIsSurvived) {
  const std::string request =
      "GET " + folder_.log() + " HTTP/1.1\r\nHost: a\r\nRange: bytes=0-99\r\n\r\n";
  for (std::size_t n = 0; n < request.size(); ++n) {
    RawClient client(server_.port());
    ASSERT_TRUE(client.send(request.substr(0, n)));
    client.finishSending();
    const std::string answer = client.readToEnd();
    EXPECT_TRUE(answer.empty() || answer.starts_with("HTTP/1.1 400"))
        << n << ": " << answer.substr(0, 40);
  }
  EXPECT_EQ(RawClient(server_.port()).get("/v1/meshes").status, 200u);
}

TEST_F(HttpServerTest, connectionCloseAndHttp10Close) {
  for (const char* request : {"GET /v1/meshes HTTP/1.1\r\nHost: a\r\nConnection: x, Close\r\n\r\n",
                              "GET /v1/meshes HTTP/1.0\r\n\r\n"}) {
    RawClient client(server_.port());
    client.send(request);
    const HttpResponse response = client.receive();
    EXPECT_EQ(response.status, 200u);
    EXPECT_EQ(response.header("connection"), "close");
    EXPECT_TRUE(client.closedByServer());
  }
}

struct Malformed {
  const char* name;
  std::string bytes;
  unsigned status;
};

TEST_F(HttpServerTest, whatCanBeReadInTwoWaysIsRefusedAndNothingAfterItIsAnswered) {
  const std::string next = "GET /v1/meshes HTTP/1.1\r\nHost: a\r\n\r\n";
  const std::vector<Malformed> cases = {
      {"no HTTP", "hello\r\n\r\n", 400},
      {"TLS",
       std::string("\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03", 11) + std::string(20, '\0') +
           "\r\n\r\n",
       400},
      {"no host", "GET / HTTP/1.1\r\n\r\n", 400},
      {"two hosts", "GET / HTTP/1.1\r\nHost: a\r\nHost: b\r\n\r\n", 400},
      {"no host at all", "GET / HTTP/1.1\r\nHost: a b\r\n\r\n", 400},
      {"odd version", "GET / HTTP/1.9\r\nHost: a\r\n\r\n", 505},
      {"a body", "GET / HTTP/1.1\r\nHost: a\r\nContent-Length: 5\r\n\r\nhello", 413},
      {"a huge body", "POST / HTTP/1.1\r\nHost: a\r\nContent-Length: 10737418240\r\n\r\n", 413},
      {"two lengths",
       "POST / HTTP/1.1\r\nHost: a\r\nContent-Length: 5\r\nContent-Length: 6\r\n\r\nhello", 400},
      {"two equal lengths",
       "POST / HTTP/1.1\r\nHost: a\r\nContent-Length: 5\r\nContent-Length: 5\r\n\r\nhello", 400},
      {"a list of lengths", "POST / HTTP/1.1\r\nHost: a\r\nContent-Length: 5, 5\r\n\r\nhello", 400},
      {"a length with a sign", "POST / HTTP/1.1\r\nHost: a\r\nContent-Length: +5\r\n\r\nhello",
       400},
      {"a length without digits", "POST / HTTP/1.1\r\nHost: a\r\nContent-Length:\r\n\r\nhello",
       400},
      {"twice the same host", "GET / HTTP/1.1\r\nHost: a\r\nhost: a\r\n\r\n", 400},
      {"two tokens",
       "GET / HTTP/1.1\r\nHost: a\r\nAuthorization: Bearer x\r\nAuthorization: Bearer x\r\n\r\n",
       400},
      {"two content ranges",
       "PUT / HTTP/1.1\r\nHost: a\r\nContent-Range: bytes 0-1/2\r\nContent-Range: bytes "
       "0-1/2\r\nContent-Length: 2\r\n\r\nab",
       400},
      {"two If-Range",
       "GET / HTTP/1.1\r\nHost: a\r\nRange: bytes=0-1\r\nIf-Range: \"a\"\r\nIf-Range: "
       "\"b\"\r\n\r\n",
       400},
      {"two dates",
       "GET / HTTP/1.1\r\nHost: a\r\nIf-Modified-Since: x\r\nIf-Modified-Since: y\r\n\r\n", 400},
      {"two origins", "GET / HTTP/1.1\r\nHost: a\r\nOrigin: http://a\r\nOrigin: http://b\r\n\r\n",
       400},
      {"another expectation",
       "GET / HTTP/1.1\r\nHost: a\r\nExpect: 100-continue\r\nExpect: 200-ok\r\n\r\n", 417},
      {"an expectation of a value", "GET / HTTP/1.1\r\nHost: a\r\nExpect: 100-continue=1\r\n\r\n",
       417},
      {"chunks twice",
       "POST / HTTP/1.1\r\nHost: a\r\nTransfer-Encoding: identity\r\nTransfer-Encoding: "
       "chunked\r\n\r\n0\r\n\r\n",
       501},
      {"length and chunks",
       "POST / HTTP/1.1\r\nHost: a\r\nContent-Length: 5\r\nTransfer-Encoding: "
       "chunked\r\n\r\n0\r\n\r\n",
       400},
      {"chunks", "POST / HTTP/1.1\r\nHost: a\r\nTransfer-Encoding: chunked\r\n\r\n0\r\n\r\n", 501},
      {"chunks in 1.0", "POST / HTTP/1.0\r\nTransfer-Encoding: chunked\r\n\r\n0\r\n\r\n", 400},
      {"space in a name", "GET / HTTP/1.1\r\nHost: a\r\nX A: 1\r\n\r\n", 400},
      {"NUL in a value", std::string("GET / HTTP/1.1\r\nHost: a\r\nX: 1\0002\r\n\r\n", 35), 400},
      {"a folded line", "GET / HTTP/1.1\r\nHost: a\r\nX: 1\r\n 2\r\n\r\n", 400},
      {"bare line ends", "GET / HTTP/1.1\nHost: a\n\n", 400},
      {"a long head",
       "GET / HTTP/1.1\r\nHost: a\r\nX: " + std::string(limits::kMaxHeaderBytes, 'x') + "\r\n\r\n",
       431},
      {"a long target", "GET /" + std::string(1 << 16, 'a') + " HTTP/1.1\r\nHost: a\r\n\r\n", 431},
  };
  for (const Malformed& c : cases) {
    RawClient client(server_.port());
    client.send(c.bytes + next);
    const HttpResponse response = client.receive();
    EXPECT_EQ(response.status, c.status) << c.name;
    EXPECT_EQ(response.header("content-type"), "application/problem+json") << c.name;
    EXPECT_TRUE(client.closedByServer()) << c.name;
  }
  EXPECT_EQ(RawClient(server_.port()).get("/v1/meshes").status, 200u);
}

TEST_F(HttpServerTest, listsOnSeveralLinesAreOneList) {
  RawClient client(server_.port());
  const std::string tag = client.get(folder_.log()).header("etag");
  EXPECT_EQ(client.get(folder_.log(), "If-None-Match: \"other\"\r\nIf-None-Match: " + tag + "\r\n")
                .status,
            304u);
  EXPECT_EQ(client.get(folder_.log(), "If-Match: \"other\"\r\nIf-Match: " + tag + "\r\n").status,
            200u);
  EXPECT_EQ(client.get("/v1/meshes/noise", "Accept-Encoding: br\r\nAccept-Encoding: gzip\r\n")
                .header("content-encoding"),
            "gzip");
  EXPECT_EQ(client.get("/v1/meshes", "Connection: keep-alive\r\nConnection: close\r\n")
                .header("connection"),
            "close");
}

TEST_F(HttpServerTest, onlyAClientOfHttp10IsToldThatTheConnectionStays) {
  RawClient client(server_.port());
  EXPECT_EQ(client.get("/livez").headers.count("connection"), 0u);
  ASSERT_TRUE(client.send("GET /v1/meshes HTTP/1.0\r\nConnection: keep-alive\r\n\r\n"));
  EXPECT_EQ(client.receive().header("connection"), "keep-alive");
  EXPECT_EQ(client.get("/v1/meshes").status, 200u) << "and it did";
}

TEST_F(HttpServerTest, anIdComesBackToWhoHasSentOne) {
  RawClient client(server_.port());
  EXPECT_EQ(client.get("/v1/meshes").headers.count("x-request-id"), 0u) << "no log has it";
  EXPECT_EQ(client.get("/v1/meshes", "X-Request-Id: mine\r\n").header("x-request-id"), "mine");
}

TEST_F(HttpServerTest, theHeadOfASmallAnswerIsSmall) {
  RawClient client(server_.port());
  ASSERT_TRUE(client.send("GET /v1/meshes HTTP/1.1\r\nHost: a\r\nConnection: close\r\n\r\n"));
  const std::string all = client.readToEnd();
  EXPECT_LT(all.find("\r\n\r\n"), 400u) << all.substr(0, all.find("\r\n\r\n"));
}

TEST_F(HttpServerTest, twoRangesOnTwoLinesAreAsManyOnOneAndIgnored) {
  RawClient client(server_.port());
  const HttpResponse whole = client.get(folder_.log(), "Range: bytes=0-1\r\nRange: bytes=2-3\r\n");
  EXPECT_EQ(whole.status, 200u);
  EXPECT_EQ(whole.body, folder_.file());
}

TEST_F(HttpServerTest, aLengthOfZeroIsNoBody) {
  RawClient client(server_.port());
  EXPECT_EQ(client.get("/v1/meshes", "Content-Length: 0\r\n").status, 200u);
  client.send("DELETE /v1/meshes HTTP/1.1\r\nHost: a\r\nContent-Length: 0\r\n\r\n");
  const HttpResponse response = client.receive();
  EXPECT_EQ(response.status, 405u);
  EXPECT_EQ(response.header("allow"), "GET, HEAD, OPTIONS");
}

TEST_F(HttpServerTest, traversalLeadsNowhere) {
  for (const char* target :
       {"/../../../../etc/passwd", "/%2e%2e/%2e%2e/%2e%2e/etc/passwd",
        "/..%2f..%2f..%2fetc%2fpasswd", "/%252e%252e/etc/passwd", "//etc/passwd",
        "/..\\..\\etc\\passwd", "/%c0%ae%c0%ae/etc/passwd", "/..;/etc/passwd",
        "/.%2e/.%2e/etc/passwd", "/v1/meshes/..%2f..%2fetc%2fpasswd/log", "/index.html%00.txt",
        "/assets/..%2f.secret", "/.git/config"}) {
    RawClient client(server_.port());
    const HttpResponse response = client.get(target);
    EXPECT_TRUE(response.status == 404 || response.status == 400)
        << target << " " << response.status;
    EXPECT_EQ(response.body.find("root:"), std::string::npos);
    EXPECT_EQ(response.body.find("hidden"), std::string::npos);
  }
}

TEST_F(HttpServerTest, aClientThatVanishesAmidAResponseHarmsNobody) {
  for (int i = 0; i < 20; ++i) {
    RawClient client(server_.port());
    const std::string request = "GET " + folder_.log() + " HTTP/1.1\r\nHost: a\r\n\r\n";
    client.send(request + request);
  }
  EXPECT_EQ(RawClient(server_.port()).get("/v1/meshes").status, 200u);
}

/// Makes levels when told to.
struct SlowMaker {
  std::mutex mutex;
  std::condition_variable changed;
  bool go = false;
  std::atomic<int> begun = 0;
  std::atomic<int> stopped = 0;

  Result<LevelFile> operator()(const LevelRequest& request, const std::stop_token& stop) {
    const std::stop_callback wake(stop, [this] { ++stopped, changed.notify_all(); });
    ++begun;
    std::unique_lock lock(mutex);
    changed.wait(lock, [&] { return go || stop.stop_requested(); });
    if (request.level == 11) return fail(ErrorCode::kBadCodec, "broken on purpose");
    return inMemory(Bytes(request.level + 1, 'v'));
  }
  void release() {
    const std::scoped_lock lock(mutex);
    go = true;
    changed.notify_all();
  }
};

class LevelsTest : public ::testing::Test {
 protected:
  ~LevelsTest() override { maker_.release(); }
  test::ServedFolder folder_;
  SlowMaker maker_;
  test::RunningServer server_{folder_.store(),
                              folder_.viewer(),
                              {.maxLevelsPerAddress = 0,
                               .timeouts = {.grace = test::kNever},
                               .makeLevel = std::ref(maker_)}};
};

TEST_F(LevelsTest, whileALevelIsMadeOthersAreServed) {
  RawClient slow(server_.port());
  slow.send("GET " + folder_.log("levels/4.vtu") + " HTTP/1.1\r\nHost: a\r\n\r\n");
  RawClient other(server_.port());
  EXPECT_EQ(other.get(folder_.log()).status, 200u);
  maker_.release();
  const HttpResponse level = slow.receive();
  EXPECT_EQ(level.status, 200u);
  EXPECT_EQ(level.body, "vvvvv");
  EXPECT_EQ(slow.get("/v1/meshes").status, 200u) << "the connection stays";
}

TEST_F(LevelsTest, beyondTheBoundTheAnswerIsToComeBack) {
  constexpr std::size_t kLevels = 11;  // the maker breaks the last one of 12
  const std::vector<std::string> forms = {"drc", "glb", "obj", "vtu", "vtk", "msh"};
  std::vector<std::unique_ptr<RawClient>> waiting;
  for (std::size_t i = 0; i < limits::kMaxLevelJobs; ++i) {
    waiting.push_back(std::make_unique<RawClient>(server_.port()));
    waiting.back()->send(
        "GET " +
        folder_.log("levels/" + std::to_string(i % kLevels) + "." + forms.at(i / kLevels)) +
        " HTTP/1.1\r\nHost: a\r\n\r\n");
  }
  EXPECT_TRUE(server_.comesTo("levels_wanted", limits::kMaxLevelJobs));
  RawClient late(server_.port());
  const HttpResponse refused = late.get(folder_.log("levels/10.usda"));
  EXPECT_EQ(refused.status, 503u);
  EXPECT_EQ(refused.header("retry-after"), "2");
  maker_.release();
  for (auto& client : waiting) EXPECT_EQ(client->receive().status, 200u);
  EXPECT_EQ(late.get(folder_.log("levels/10.usda")).status, 200u);
}

TEST_F(LevelsTest, oneAddressLeavesPlacesToOthers) {
  test::RunningServer server(folder_.store(), folder_.viewer(), {.makeLevel = std::ref(maker_)});
  std::vector<std::unique_ptr<RawClient>> waiting;
  for (std::size_t i = 0; i <= limits::kMaxLevelJobsPerAddress; ++i) {
    waiting.push_back(std::make_unique<RawClient>(server.port()));
    waiting.back()->send(
        "GET " +
        folder_.log("levels/" + std::to_string(i % limits::kMaxLevelJobsPerAddress) + ".drc") +
        " HTTP/1.1\r\nHost: a\r\n\r\n");
  }
  EXPECT_TRUE(server.comesTo("levels_wanted", limits::kMaxLevelJobsPerAddress + 1))
      << "what is being made already takes no place more";
  RawClient late(server.port());
  const HttpResponse refused = late.get(folder_.log("levels/10.drc"));
  EXPECT_EQ(refused.status, 429u);
  EXPECT_EQ(refused.header("retry-after"), "2");
  maker_.release();
  for (auto& client : waiting) EXPECT_EQ(client->receive().status, 200u);
  EXPECT_EQ(late.get(folder_.log("levels/10.drc")).status, 200u) << "the connection stays";
}

TEST_F(LevelsTest, aLevelThatCannotBeMadeIsTheServersFault) {
  maker_.release();
  RawClient client(server_.port());
  const HttpResponse response = client.get(folder_.log("levels/11.vtu"));
  EXPECT_EQ(response.status, 500u);
  EXPECT_NE(response.body.find("broken on purpose"), std::string::npos);
  EXPECT_NE(response.body.find("qtet verify"), std::string::npos)
      << "whose checksums hold and which cannot be decoded";
  EXPECT_EQ(client.get(folder_.log("levels/0.vtu")).body, "v");
}

TEST_F(LevelsTest, headAndConditionsMakeNothing) {
  RawClient client(server_.port());
  client.send("HEAD " + folder_.log("levels/3.vtu") + " HTTP/1.1\r\nHost: a\r\n\r\n");
  const HttpResponse head = client.receive(true);
  EXPECT_EQ(head.status, 200u);
  EXPECT_EQ(
      client.get(folder_.log("levels/3.vtu"), "If-None-Match: " + head.header("etag") + "\r\n")
          .status,
      304u);
  EXPECT_EQ(maker_.begun, 0);
}

TEST_F(LevelsTest, aResponseUnderWayIsFinishedWhenTheServerEnds) {
  RawClient client(server_.port());
  client.send("GET " + folder_.log("levels/4.vtu") + " HTTP/1.1\r\nHost: a\r\n\r\n");
  while (maker_.begun == 0) std::this_thread::yield();
  server_.stop();
  std::this_thread::sleep_for(test::kQuiet);
  maker_.release();
  const HttpResponse response = client.receive();
  EXPECT_EQ(response.status, 200u);
  EXPECT_EQ(response.body, "vvvvv");
  EXPECT_EQ(response.header("connection"), "close");
  EXPECT_TRUE(client.closedByServer());
  client.finishSending();
  server_.join();
}

TEST_F(LevelsTest, aServerThatGoesWhileALevelIsMadeWaitsForNobodyElse) {
  auto client = std::make_unique<RawClient>(server_.port());
  client->send("GET " + folder_.log("levels/4.vtu") + " HTTP/1.1\r\nHost: a\r\n\r\n");
  while (maker_.begun == 0) std::this_thread::yield();
  client.reset();
  server_.stop();
  maker_.release();
  server_.join();
}

TEST(ServerEnd, idleConnectionsAreClosedAtOnceAndNobodyNewIsLetIn) {
  const test::ServedFolder folder;
  test::RunningServer server(
      folder.store(), folder.viewer(),
      {.threads = 2, .timeouts = {.idle = test::kNever, .grace = test::kNever}});
  const std::uint16_t port = server.port();
  RawClient idle(port);
  EXPECT_EQ(idle.get("/v1/meshes").status, 200u);
  server.stop();
  EXPECT_TRUE(idle.closedByServer());
  server.join();
  EXPECT_THROW(RawClient{port}, std::exception);
}

TEST(ServerLimits, oneConnectionTooManyIsTurnedAwayAndALaterOneIsServed) {
  const test::ServedFolder folder;
  test::RunningServer server(folder.store(), folder.viewer(), {.threads = 2, .maxConnections = 2});
  auto first = std::make_unique<RawClient>(server.port());
  EXPECT_EQ(first->get("/v1/meshes").status, 200u);
  RawClient second(server.port());
  EXPECT_EQ(second.get("/v1/meshes").status, 200u);
  RawClient third(server.port());
  const HttpResponse refused = third.receive();  // unasked: it is not even read
  EXPECT_EQ(refused.status, 503u);
  EXPECT_EQ(refused.header("retry-after"), "2");
  EXPECT_TRUE(third.closedByServer());
  first.reset();
  EXPECT_TRUE(
      test::eventually([&] { return RawClient(server.port()).get("/v1/meshes").status == 200; }));
}

TEST_F(LevelsTest, whenTheClientGoesTheJobEnds) {
  auto client = std::make_unique<RawClient>(server_.port());
  client->send("GET " + folder_.log("levels/4.vtu") + " HTTP/1.1\r\nHost: a\r\n\r\n");
  while (maker_.begun == 0) std::this_thread::yield();
  client.reset();
  EXPECT_TRUE(test::eventually([&] { return maker_.stopped == 1; }));
}

TEST_F(LevelsTest, aLevelComesInRangesToo) {
  maker_.release();
  RawClient client(server_.port());
  const HttpResponse part = client.get(folder_.log("levels/9.drc"), "Range: bytes=2-4\r\n");
  EXPECT_EQ(part.status, 206u);
  EXPECT_EQ(part.header("content-range"), "bytes 2-4/10");
  EXPECT_EQ(part.body, "vvv");
  EXPECT_EQ(client.get(folder_.log("levels/9.drc"), "Range: bytes=10-\r\n").status, 416u);
}

TEST_F(LevelsTest, manyWhoWantTheSameLevelCostOneJob) {
  std::vector<std::unique_ptr<RawClient>> clients;
  for (std::size_t i = 0; i < 2 * limits::kMaxLevelJobs; ++i) {
    clients.push_back(std::make_unique<RawClient>(server_.port()));
    clients.back()->send("GET " + folder_.log("levels/4.vtu") + " HTTP/1.1\r\nHost: a\r\n\r\n");
  }
  EXPECT_TRUE(server_.comesTo("levels_wanted", clients.size()));
  maker_.release();
  for (auto& client : clients) EXPECT_EQ(client->receive().body, "vvvvv");
  EXPECT_EQ(maker_.begun, 1);
}

TEST(ServerLimits, oneAddressMayHaveSoManyConnections) {
  const test::ServedFolder folder;
  test::RunningServer server(folder.store(), folder.viewer(), {.maxConnectionsPerAddress = 2});
  RawClient first(server.port()), second(server.port());
  EXPECT_EQ(first.get("/v1/meshes").status, 200u);
  EXPECT_EQ(second.get("/v1/meshes").status, 200u);
  RawClient third(server.port());
  const HttpResponse refused = third.receive();
  EXPECT_EQ(refused.status, 429u);
  EXPECT_EQ(refused.header("retry-after"), "2");
  EXPECT_TRUE(third.closedByServer());
}

TEST(ServerLimits, aHeadThatIsRefusedHasNoBodyThatTheNextAnswerWouldBeTakenFor) {
  const test::ServedFolder folder;
  test::RunningServer server(folder.store(), folder.viewer(), {.maxRequestsPerSecond = 1});
  RawClient client(server.port());
  constexpr int kRequests = 50;
  std::string requests;
  for (int i = 0; i < kRequests; ++i) requests += "HEAD /livez HTTP/1.1\r\nHost: a\r\n\r\n";
  client.send(requests);
  int refused = 0;
  for (int i = 0; i < kRequests; ++i) {
    const HttpResponse response = client.receive(true);
    ASSERT_TRUE(response.status == 200 || response.status == 429) << i << " " << response.status;
    refused += response.status == 429;
    EXPECT_NE(response.header("content-length"), "0") << "that of the answer to a GET";
  }
  EXPECT_GT(refused, 0);
}

/// Whole lines behind the request line of a HEAD that is refused, and by which status.
struct RefusedHead {
  std::string target, lines;
  unsigned status;
};

TEST(ServerLimits, everyRefusalOfAHeadIsItsHeadersAlone) {
  const test::ServedFolder folder;
  Access access(
      *Tokens::parse("write * aSecretOfTwentyTwoChars\nread * aSecretOfTwentyTwoChars\n"));
  test::RunningServer server(folder.store(), folder.viewer(), {.access = &access});
  const std::string host = "Host: a\r\n";
  for (const RefusedHead& head : std::vector<RefusedHead>{
           {"/livez", "", 400},
           {"/livez", host + host, 400},
           {"/livez", "Host: a b\r\n", 400},
           {"/livez", host + "Origin: a\r\nOrigin: b\r\n", 400},
           {"/livez", host + "Expect: much\r\n", 417},
           {"/livez", host + "Transfer-Encoding: chunked\r\n", 501},
           {"/livez", host + "Content-Length: 5\r\n", 413},
           {"/livez", host + "Content-Length: x\r\n", 400},
           {"/a%00b", host, 400},
           {"/v1/tickets", host, 405},
           {"/v1/stream", host, 426},
           {"/v1/stream", host + "Connection: Upgrade\r\nUpgrade: websocket\r\n", 426},
           {"/v1/meshes/noise", host, 401},
           {"/v1/meshes/noise/upload", host, 401},
           {"/nothing", host, 404}}) {
    RawClient client(server.port());
    client.send("HEAD " + head.target + " HTTP/1.1\r\n" + head.lines + "\r\n");
    client.finishSending();
    const std::string answer = client.readToEnd();
    EXPECT_TRUE(answer.starts_with("HTTP/1.1 " + std::to_string(head.status))) << answer;
    EXPECT_EQ(answer.find("\r\n\r\n"), answer.size() - 4) << head.lines << answer;
  }
}

TEST(ServerLimits, aHeadRefusedBeforeItIsWholeIsAnsweredByHeadersAlone) {
  const test::ServedFolder folder;
  const test::RunningServer patient(folder.store(), folder.viewer(), {});
  const test::RunningServer hasty(folder.store(), folder.viewer(),
                                  {.timeouts = {.header = test::kShort}});
  const std::string begin = "HEAD /livez HTTP/1.1\r\nHost: a\r\n";
  std::string lines = begin;
  for (std::size_t i = 0; i <= limits::kMaxHeaderLines; ++i) lines += "A: b\r\n";
  for (const auto& [bytes, status] : std::vector<std::pair<std::string, unsigned>>{
           {"HEAD /livez HTTP/2.0\r\nHost: a\r\n\r\n", 505},
           {begin + "A: " + std::string(limits::kMaxHeaderBytes, 'b') + "\r\n\r\n", 431},
           {lines + "\r\n", 431},
           {begin + "A: b\nC: d\r\n\r\n", 400},
           {begin + "no colon\r\n\r\n", 400},
           {begin, 408}}) {
    RawClient client(status == 408 ? hasty.port() : patient.port());
    client.send(bytes);
    const std::string answer = client.readToEnd();
    EXPECT_TRUE(answer.starts_with("HTTP/1.1 " + std::to_string(status))) << answer;
    EXPECT_EQ(answer.find("\r\n\r\n"), answer.size() - 4) << status << answer;
  }
  RawClient other(patient.port());
  other.send("HEADS /livez HTTP/2.0\r\nHost: a\r\n\r\n");
  EXPECT_NE(other.receive().body, "") << "another method";
}

TEST(ServerLimits, oneAddressMayAskSoOften) {
  const test::ServedFolder folder;
  test::RunningServer server(folder.store(), folder.viewer(), {.maxRequestsPerSecond = 5});
  RawClient client(server.port());
  // Sent at once: a server that stalls for 30 s among them would still have too many.
  constexpr int kRequests = 200;
  std::string requests;
  for (int i = 0; i < kRequests; ++i) requests += "GET /livez HTTP/1.1\r\nHost: a\r\n\r\n";
  client.send(requests);
  int refused = 0;
  for (int i = 0; i < kRequests; ++i) {
    const unsigned status = client.receive().status;
    EXPECT_TRUE(status == 200 || (status == 429 && i >= 10))
        << "two seconds' requests may come at once: " << i << " " << status;
    refused += status == 429;
  }
  EXPECT_GT(refused, 0);
  EXPECT_TRUE(test::eventually([&] { return client.get("/livez").status == 200; }))
      << "the connection stays, and time heals";
}

TEST(ServerLimits, aHeadAndASilenceEndInTime) {
  const test::ServedFolder folder;
  const auto with = [&](Timeouts timeouts) {
    return std::make_unique<test::RunningServer>(folder.store(), folder.viewer(),
                                                 ServerOptions{.timeouts = timeouts});
  };
  const auto hasty = with({.header = test::kShort, .idle = test::kNever}),
             patient = with({.header = test::kNever, .idle = test::kShort});
  RawClient slow(hasty->port()), silent(patient->port());
  slow.send("GET /v1/meshes HTTP/1.1\r\nHost:");
  EXPECT_EQ(slow.receive().status, 408u);
  EXPECT_TRUE(slow.closedByServer());
  EXPECT_TRUE(silent.closedByServer()) << "without a word: nothing was asked";
  RawClient kept(patient->port());
  EXPECT_EQ(kept.get("/livez").status, 200u);
  EXPECT_TRUE(kept.closedByServer()) << "the limit of the first wait is over, that of this one not";
  const auto lasting = with({.header = test::kNever, .idle = test::kNever});
  RawClient late(lasting->port());
  late.send("GET /v1/meshes HTTP/1.1\r\n");
  std::this_thread::sleep_for(test::kQuiet);
  late.send("Host: a\r\n\r\n");
  EXPECT_EQ(late.receive().status, 200u) << "slow, but in time";
}

TEST(ServerLimits, aHeadOfTheLargestSizeIsReadAndNoLargerOne) {
  const test::ServedFolder folder;
  test::RunningServer server(folder.store(), folder.viewer());
  const std::string before = "GET /v1/meshes HTTP/1.1\r\nHost: a\r\nX: ", after = "\r\n\r\n";
  const std::size_t room = limits::kMaxHeaderBytes - before.size() - after.size();
  for (const int more : {-1, 0, 1}) {
    RawClient client(server.port());
    client.send(before + std::string(room + static_cast<std::size_t>(more), 'x') + after);
    EXPECT_EQ(client.receive().status, more <= 0 ? 200u : 431u) << more;
  }
}

TEST(ServerStart, aPortInUseIsAnErrorThatSaysSo) {
  const test::ServedFolder folder;
  const test::RunningServer server(folder.store(), folder.viewer());
  Server second(folder.store(), folder.viewer(), {.port = server.port()});
  const Status status = second.listen();
  ASSERT_FALSE(status);
  EXPECT_EQ(status.error().code, ErrorCode::kIo);
  EXPECT_NE(status.error().message.find("--port"), std::string::npos);
}

TEST(ServerStart, aHostThatDoesNotExistIsAnError) {
  const test::ServedFolder folder;
  Server server(folder.store(), folder.viewer(), {.host = "203.0.113.7", .port = 0});
  EXPECT_FALSE(server.listen());
}

}  // namespace
}  // namespace qtet
