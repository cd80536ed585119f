// Figures, access log, request ids and the operators' address.
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "codec/log/log_versions.h"
#include "proto/version.h"
#include "server/wire/http_limits.h"
#include "server/wire/request_trace.h"
#include "tests/server/program/loopback.h"
#include "tests/server/program/served_folder.h"
#include "tests/server/support/json.h"

namespace qtet {
namespace {

using test::Json;

TEST(RequestTrace, aSoundIdIsKeptAndAnythingElseReplaced) {
  EXPECT_EQ(traceOf("abc-1.2_3", std::nullopt).id, "abc-1.2_3");
  EXPECT_EQ(traceOf(std::string(128, 'a'), std::nullopt).id, std::string(128, 'a'));
  for (const std::string& wrong :
       {std::string(), std::string("a b"), std::string("a\"b"), std::string(129, 'a')})
    EXPECT_NE(traceOf(wrong, std::nullopt).id, wrong);
  EXPECT_NE(traceOf(std::nullopt, std::nullopt).id, traceOf(std::nullopt, std::nullopt).id);
}

TEST(RequestTrace, aTraceGoesOnUnderASpanOfItsOwn) {
  const std::string parent = "00-4bf92f3577b34da6a3ce929d0e0e4736-00f067aa0ba902b7-01";
  const RequestTrace trace = traceOf(std::nullopt, parent);
  EXPECT_EQ(trace.parentId, "00f067aa0ba902b7");
  EXPECT_TRUE(trace.traceparent().starts_with("00-4bf92f3577b34da6a3ce929d0e0e4736-"));
  EXPECT_TRUE(trace.traceparent().ends_with("-01"));
  EXPECT_EQ(trace.traceparent().size(), parent.size());
  EXPECT_NE(trace.traceparent(), parent);
  for (const char* wrong : {"", "00-4bf92f3577b34da6a3ce929d0e0e4736-00f067aa0ba902b7",
                            "00-00000000000000000000000000000000-00f067aa0ba902b7-01",
                            "00-4bf92f3577b34da6a3ce929d0e0e4736-0000000000000000-01",
                            "00-4BF92F3577B34DA6A3CE929D0E0E4736-00f067aa0ba902b7-01",
                            "ff-4bf92f3577b34da6a3ce929d0e0e4736-00f067aa0ba902b7-01"})
    EXPECT_EQ(traceOf(std::nullopt, wrong).traceparent(), "") << wrong;
}

/// A served folder, and an access log for its server.
struct Logged {
  test::ServedFolder folder;
  test::TempFolder out;
  std::filesystem::path path = out.path() / "access.json";
  Result<std::unique_ptr<AccessLog>> log = AccessLog::open(path.string());
};

TEST(AccessLog, aLineOfJsonForEveryRequest) {
  const Logged logged;
  ASSERT_TRUE(logged.log);
  {
    test::RunningServer server(logged.folder.store(), logged.folder.viewer(),
                               {.accessLog = logged.log->get()});
    test::RawClient client(server.port());
    const auto response = client.get("/v1/meshes?x=\"%s",
                                     "X-Request-Id: mine\r\ntraceparent: "
                                     "00-4bf92f3577b34da6a3ce929d0e0e4736-00f067aa0ba902b7-01\r\n");
    EXPECT_EQ(response.header("x-request-id"), "mine");
    EXPECT_TRUE(response.header("traceparent").starts_with("00-4bf92f3577b34da6a3ce929d0e0e4736-"));
    EXPECT_EQ(client.get("/nothing").status, 404u);
    test::RawClient(server.port()).send("\x16\x03");
  }
  std::ifstream in(logged.path);
  std::vector<Json> lines;
  for (std::string line; std::getline(in, line);) lines.push_back(Json::parse(line));
  ASSERT_GE(lines.size(), 2u);
  EXPECT_EQ(lines[0]["id"], "mine");
  EXPECT_EQ(lines[0]["client"], "127.0.0.1");
  EXPECT_EQ(lines[0]["method"], "GET");
  EXPECT_EQ(lines[0]["target"], "/v1/meshes?x=\"%s");
  EXPECT_EQ(lines[0]["status"], 200);
  EXPECT_EQ(lines[0]["traceId"], "4bf92f3577b34da6a3ce929d0e0e4736");
  EXPECT_GT(lines[0]["bytes"].count(), 100u);
  EXPECT_TRUE(lines[0]["whole"].isTrue());
  EXPECT_EQ(lines[0]["time"].string().size(), std::string("2026-01-01T00:00:00.000Z").size());
  EXPECT_EQ(lines[1]["status"], 404);
}

TEST(AccessLog, bytesAreThoseOfTheBodyHoweverItIsSent) {
  const Logged logged;
  ASSERT_TRUE(logged.log);
  std::vector<std::pair<std::string, std::size_t>> sent;  // id and body's bytes
  {
    test::RunningServer server(logged.folder.store(), logged.folder.viewer(),
                               {.accessLog = logged.log->get()});
    test::RawClient client(server.port());
    for (const std::size_t bytes : {std::size_t{1}, limits::kMaxWithHead - 1, limits::kMaxWithHead,
                                    limits::kMaxWithHead + 1}) {
      const auto response =
          client.get(logged.folder.log(), "Range: bytes=0-" + std::to_string(bytes - 1) + "\r\n");
      EXPECT_EQ(response.body, logged.folder.file().substr(0, bytes));
      sent.emplace_back(response.header("x-request-id"), bytes);
    }
  }
  std::ifstream in(logged.path);
  for (const auto& [id, bytes] : sent) {
    std::string line;
    ASSERT_TRUE(std::getline(in, line));
    EXPECT_EQ(Json::parse(line)["id"], id) << "the log's line is found by it";
    EXPECT_EQ(Json::parse(line)["bytes"], bytes);
    EXPECT_TRUE(Json::parse(line)["whole"].isTrue());
  }
}

TEST(AccessLog, aStreamHasALineAtItsEnd) {
  const Logged logged;
  ASSERT_TRUE(logged.log);
  std::size_t bytes = 0, frames = 0;
  {
    test::RunningServer server(logged.folder.store(), logged.folder.viewer(),
                               {.accessLog = logged.log->get()});
    test::StreamClient client(server.port());
    const std::string mesh = logged.folder.store().catalogue()->meshes.begin()->get()->id;
    ASSERT_TRUE(client.send(R"({"type":"open","mesh":")" + mesh + R"(","credit":1})"));
    while (const auto message = client.receive(frames == 1 ? test::kQuiet : test::kPatience)) {
      bytes += message->bytes.size();
      frames += message->binary;
    }
    EXPECT_TRUE(server.comesTo("stream_credit_waits_total", 1));
    EXPECT_TRUE(server.comesTo("streams_open", 1));
    client.close();
    EXPECT_TRUE(server.comesTo("streams_open", 0));
    EXPECT_TRUE(server.comesTo("streams_total", 1));
    EXPECT_TRUE(server.comesTo("stream_first_frame_seconds_count", 1));
  }
  std::ifstream in(logged.path);
  Json stream;
  for (std::string line; std::getline(in, line);)
    if (const Json one = Json::parse(line); one.contains("stream")) stream = one;
  ASSERT_FALSE(stream.isNull());
  EXPECT_EQ(stream["client"], "127.0.0.1");
  EXPECT_EQ(stream["target"], "/v1/stream");
  EXPECT_EQ(stream["status"], 101);
  EXPECT_GT(stream["bytes"].count(), bytes) << "with the heads of frames";
  EXPECT_LT(stream["bytes"].count(), bytes + 1000);
  EXPECT_GT(stream["ms"].number(), 0);
  EXPECT_EQ(stream["stream"]["opens"], 1);
  EXPECT_EQ(stream["stream"]["frames"], frames);
  EXPECT_EQ(stream["stream"]["creditWaits"], 1);
  EXPECT_EQ(stream["stream"]["end"], "closed-by-client");
  EXPECT_GE(stream["stream"]["firstFrameMs"].number(), 0);
  EXPECT_LE(stream["stream"]["firstFrameMs"].number(), stream["ms"].number());
}

TEST(AccessLog, aStreamsLineSaysWhyItEnded) {
  const Logged logged;
  ASSERT_TRUE(logged.log);
  {
    test::RunningServer server(
        logged.folder.store(), logged.folder.viewer(),
        {.timeouts = {.silence = test::kShort}, .accessLog = logged.log->get()});
    test::StreamClient wrong(server.port());
    ASSERT_TRUE(wrong.send("no json"));
    EXPECT_EQ(wrong.closeCode(), 1008u);
    EXPECT_TRUE(server.comesTo("streams_open", 0));
    test::StreamClient(server.port()).vanish();
    EXPECT_TRUE(server.comesTo("streams_total", 2));
    EXPECT_TRUE(server.comesTo("streams_open", 0));
    const test::StreamClient staying(server.port());
    EXPECT_TRUE(server.comesTo("streams_open", 1));
    server.stop();
    server.join();
  }
  std::ifstream in(logged.path);
  std::vector<std::string> ends;
  for (std::string line; std::getline(in, line);)
    if (const Json one = Json::parse(line); one.contains("stream"))
      ends.push_back(one["stream"]["end"].string());
  EXPECT_EQ(ends, (std::vector<std::string>{"refused", "client-gone", "server-ends"}));
}

TEST(AccessLog, noTicketIsWrittenDownHoweverItWasSent) {
  const Logged logged;
  ASSERT_TRUE(logged.log);
  {
    test::RunningServer server(logged.folder.store(), logged.folder.viewer(),
                               {.accessLog = logged.log->get()});
    for (const char* target :
         {"/v1/stream?ticket=5ecret", "http://a/v1/stream?ticket=5ecret",
          "/v1/%73tream?x&ticket=5ecret", "/v1/stream/?ticket=5ecret", "/?ticket=5ecret"})
      EXPECT_NE(test::RawClient(server.port()).get(target).status, 0u) << target;
  }
  std::stringstream text;
  text << std::ifstream(logged.path).rdbuf();
  EXPECT_NE(text.str().find("http://a/v1/stream"), std::string::npos) << text.str();
  EXPECT_EQ(text.str().find("5ecret"), std::string::npos) << text.str();
}

TEST(AccessLog, noTokenIsWrittenDownWhereverItWasSent) {
  const std::string token = "a5ecretOfTwentyTwoChars";
  Access access(*Tokens::parse("write * " + token + "\n"));
  const Logged logged;
  ASSERT_TRUE(logged.log);
  {
    test::RunningServer server(logged.folder.store(), logged.folder.viewer(),
                               {.accessLog = logged.log->get(), .access = &access});
    for (const std::string& target : {"/v1/meshes?token=" + token, "/?a=" + token, "/" + token})
      EXPECT_NE(test::RawClient(server.port()).get(target).status, 0u) << target;
    const std::string id = "X-Request-Id: " + token + "\r\n";
    EXPECT_EQ(test::RawClient(server.port()).get("/livez", id).status, 200u);
    EXPECT_TRUE(test::RawClient(server.port()).send(token + " / HTTP/1.1\r\nHost: a\r\n\r\n"));
    EXPECT_EQ(test::RawClient(server.port()).get("/livez").status, 200u);
  }
  std::stringstream text;
  text << std::ifstream(logged.path).rdbuf();
  EXPECT_NE(text.str().find("/livez"), std::string::npos) << text.str();
  EXPECT_EQ(text.str().find("5ecret"), std::string::npos) << text.str();
}

TEST(AccessLog, aChangeIsWrittenDownWithItsTokensName) {
  const std::string token = "aSecretOfTwentyTwoChars", other = "anotherOfManyCharacters";
  Access access(*Tokens::parse("write new* " + token + " name=lab@1\nread * " + other));
  const Logged logged;
  ASSERT_TRUE(logged.log);
  const auto bearer = [](const std::string& t) { return "Authorization: Bearer " + t + "\r\n"; };
  {
    test::RunningServer server(logged.folder.store(), logged.folder.viewer(),
                               {.accessLog = logged.log->get(), .access = &access});
    const auto send = [&](const std::string& head, const std::string& body) {
      test::RawClient client(server.port());
      EXPECT_TRUE(client.send(head + "Host: a\r\nConnection: close\r\nContent-Length: " +
                              std::to_string(body.size()) + "\r\n\r\n" + body));
      return client.receive().status;
    };
    EXPECT_EQ(send("PUT /v1/meshes/new HTTP/1.1\r\n" + bearer(token), "no log"), 422u);
    EXPECT_EQ(send("DELETE /v1/meshes/new HTTP/1.1\r\n" + bearer(token), ""), 404u);
    EXPECT_EQ(send("DELETE /v1/meshes/new HTTP/1.1\r\n" + bearer(other), ""), 403u);
    EXPECT_EQ(send("DELETE /v1/meshes/new HTTP/1.1\r\n" + bearer(token + "x"), ""), 401u);
    EXPECT_EQ(send("POST /v1/tickets HTTP/1.1\r\n" + bearer(token), ""), 201u);
    EXPECT_EQ(send("GET /livez HTTP/1.1\r\n" + bearer(token), ""), 200u);
  }
  std::ifstream in(logged.path);
  std::vector<Json> lines;
  for (std::string line; std::getline(in, line);) lines.push_back(Json::parse(line));
  ASSERT_EQ(lines.size(), 6u);
  EXPECT_EQ(lines[0]["change"]["token"], "lab@1");
  EXPECT_EQ(lines[0]["change"]["mesh"], "new");
  EXPECT_EQ(lines[0]["change"]["received"], 6);
  EXPECT_EQ(lines[0]["status"], 422);
  EXPECT_EQ(lines[1]["change"]["token"], "lab@1");
  EXPECT_EQ(lines[1]["change"]["received"], 0);
  EXPECT_EQ(lines[2]["change"]["token"].string().size(), std::string("sha256:12345678").size());
  EXPECT_EQ(lines[3]["change"]["token"], "");
  EXPECT_EQ(lines[3]["status"], 401);
  EXPECT_EQ(lines[4]["change"]["token"], "lab@1");
  EXPECT_EQ(lines[4]["change"]["mesh"], "");
  EXPECT_EQ(lines[4]["client"], "127.0.0.1");
  EXPECT_FALSE(lines[5].contains("change"));
}

TEST(AccessLog, aFileThatCannotBeWrittenIsAnError) {
  EXPECT_EQ(AccessLog::open("/proc/nothing/log").error().code, ErrorCode::kIo);
}

TEST(Operators, theirPathsAreAnsweredBesideEverythingElse) {
  const test::ServedFolder folder;
  test::RunningServer server(folder.store(), folder.viewer());
  test::RawClient client(server.port());
  EXPECT_EQ(client.get("/livez").body, "ok\n");
  EXPECT_EQ(client.get("/readyz").status, 200u);
  const Json versions = Json::parse(client.get("/version").body);
  EXPECT_EQ(versions["version"], version());
  EXPECT_EQ(versions["logFormat"], newestLogVersion());
  EXPECT_EQ(versions["oldestLogFormat"], oldestLogVersion());
  const std::string metrics = client.get("/metrics").body;
  EXPECT_NE(metrics.find("qtet_http_requests_total{code=\"200\"} 3\n"), std::string::npos)
      << metrics;
  EXPECT_NE(metrics.find("qtet_meshes 2\n"), std::string::npos);
  EXPECT_NE(metrics.find("qtet_connections_open 1\n"), std::string::npos);
  EXPECT_NE(metrics.find("qtet_http_request_duration_seconds_bucket{route=\"admin\",method=\"GET\","
                         "le=\"+Inf\"} 3\n"),
            std::string::npos);
  EXPECT_NE(metrics.find("qtet_build_info{version=\"" + version() + "\"} 1\n"), std::string::npos);
  for (const char* name : {"cpu_seconds_total", "resident_memory_bytes", "virtual_memory_bytes",
                           "open_fds", "max_fds", "start_time_seconds"}) {
    const std::size_t at = metrics.find("\nprocess_" + std::string(name) + " ");
    ASSERT_NE(at, std::string::npos) << name;
    EXPECT_GT(std::stod(metrics.substr(metrics.find(' ', at))), 0) << name;
  }
  EXPECT_EQ(metrics.find("certificate"), std::string::npos) << "there is none";
}

TEST(Operators, anAddressOfTheirOwnHasTheirPathsAlone) {
  const test::ServedFolder folder;
  test::RunningServer server(folder.store(), folder.viewer(), {.adminHost = "127.0.0.1"});
  EXPECT_EQ(test::RawClient(server.port()).get("/metrics").status, 404u);
  EXPECT_EQ(test::RawClient(server.port()).get("/livez").status, 404u);
  test::RawClient client(server.adminPort());
  EXPECT_EQ(client.get("/metrics").status, 200u);
  EXPECT_EQ(client.get("/v1/meshes").status, 404u);
  EXPECT_EQ(test::StreamClient(server.adminPort()).httpStatus(), 404u);
}

TEST(Operators, aServerThatStillReadsItsFolderSaysSo) {
  constexpr auto kNoTime = std::chrono::milliseconds::zero();
  const test::ServedFolder viewer;
  test::TempFolder folder;
  const Bytes log = test::makeLog({.chunks = 1, .fields = {}});
  for (std::size_t i = 0; i < 300; ++i) folder.write(std::to_string(1000 + i) + ".qtet", log);
  folder.write("large.qtet", test::makeLog({.chunks = 20}));
  const auto store = MeshStore::open(
      folder.path(), {.readTime = kNoTime, .nameTime = kNoTime, .maxReadWhenAsked = log.size()});
  ASSERT_TRUE(store);
  test::RunningServer server(*store, viewer.viewer()),
      early(*store, viewer.viewer(), {.readyEarly = true});
  test::RawClient client(server.port());
  EXPECT_EQ(client.get("/readyz").status, 503u) << "names are missing";
  EXPECT_EQ(test::RawClient(early.port()).get("/readyz").status, 200u);
  EXPECT_EQ(client.get("/livez").status, 200u);
  EXPECT_EQ(client.get("/v1/meshes/1299").status, 200u);
  while (!store->catalogue()->named) ASSERT_TRUE(store->readOn());
  ASSERT_FALSE(store->catalogue()->complete());
  EXPECT_EQ(client.get("/readyz").status, 200u) << "names are known";
  const auto partial = client.get("/v1/meshes?limit=1");
  EXPECT_NE(partial.body.find(R"("complete":false)"), std::string::npos) << partial.body;
  EXPECT_EQ(client.get("/v1/meshes/1298").status, 200u);
  EXPECT_EQ(client.get("/v1/meshes/large").status, 503u) << "nobody waits for a large one";
  EXPECT_EQ(client.get("/v1/meshes/nothing").status, 404u);
  while (!store->catalogue()->complete()) ASSERT_TRUE(store->readOn());
  const auto whole = client.get("/v1/meshes?limit=1");
  EXPECT_FALSE(Json::parse(whole.body).contains("complete")) << whole.body;
  EXPECT_NE(whole.header("etag"), partial.header("etag"));
  EXPECT_EQ(client.get("/v1/meshes/large").status, 200u);
}

TEST(Operators, aServerThatDrainsServesOnAndIsNotReady) {
  const test::ServedFolder folder;
  test::RunningServer server(folder.store(), folder.viewer(), {.drain = test::kNever});
  EXPECT_EQ(test::RawClient(server.port()).get("/readyz").status, 200u);
  server.drain();
  EXPECT_TRUE(test::eventually(
      [&] { return test::RawClient(server.port()).get("/readyz").status == 503; }));
  EXPECT_EQ(test::RawClient(server.port()).get("/v1/meshes").status, 200u) << "new ones are let in";
  EXPECT_EQ(test::RawClient(server.port()).get("/livez").status, 200u);
  server.drain();
  server.join();
}

TEST(Operators, theTimeOfDrainingEndsByItself) {
  const test::ServedFolder folder;
  test::RunningServer server(folder.store(), folder.viewer(), {.drain = test::kShort});
  server.drain();
  server.join();
}

}  // namespace
}  // namespace qtet
