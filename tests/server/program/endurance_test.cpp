// Tests the program under heavy load: an end with hundreds of streams, stalled and vanished
// clients, no more files to open. QTET_STALL_SECONDS=60 makes the run with stalled clients the long
// one.
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <cstdlib>
#include <thread>

#include "server/stream/stream_limits.h"
#include "server/wire/connection_limits.h"
#include "tests/server/program/loopback.h"
#include "tests/server/program/program.h"
#include "tests/server/program/served_folder.h"
#include "tests/server/stream/swarm.h"
#include "tests/support/sanitizer.h"

namespace qtet {
namespace {

using namespace std::chrono_literals;
using test::Program;
using test::RawClient;
using test::Swarm;

class EnduranceTest : public ::testing::Test {
 protected:
  EnduranceTest() {
    const auto bytes =
        test::makeLog({.chunks = 24, .fields = {}, .largestBlock = 60'000, .seed = 3});
    log_.assign(bytes.begin(), bytes.end());
    folder_.write("logs/large.qtet", ByteView(bytes));
    rlimit files{};
    ::getrlimit(RLIMIT_NOFILE, &files);
    files.rlim_cur = files.rlim_max;
    ::setrlimit(RLIMIT_NOFILE, &files);
  }
  [[nodiscard]] std::vector<std::string> words(const std::string& threads = "2") const {
    return {folder_.path() / "logs",
            "--port",
            "0",
            "--threads",
            threads,
            "--viewer",
            files_.viewerFolder(),
            "--max-connections-per-address",
            "0",
            "--max-requests-per-second",
            "0"};
  }
  [[nodiscard]] std::string request() const {
    return "GET /v1/meshes/large HTTP/1.1\r\nHost: a\r\n\r\n";
  }
  /// Nothing but what a test does ends anything.
  [[nodiscard]] static Timeouts lasting() {
    return {.header = test::kNever,
            .handshake = test::kNever,
            .idle = test::kNever,
            .write = test::kNever,
            .body = test::kNever,
            .silence = test::kNever,
            .grace = test::kNever};
  }
  static bool allEnded(const Swarm& swarm) {
    return swarm.count([](const Swarm::Client& client) { return !client.ended; }) == 0;
  }

  test::TempFolder folder_;
  test::ServedFolder files_;  // for the viewer's
  std::string log_;
};

// In this process, since a program's 8 s of grace are few on a machine that stalls; how the program
// itself ends is program_test.cpp's.
TEST_F(EnduranceTest, sigtermWithHundredsOfStreamsLosesNoByteOfAny) {
  constexpr std::size_t kStreams = 200;
  const MeshStore store = *MeshStore::open(folder_.path() / "logs");
  test::RunningServer server(store, files_.viewer(),
                             {.threads = 2, .timeouts = lasting(), .endOnSignals = true});
  Swarm swarm(server.port(), "large", log_, kStreams, 64 << 10);
  const auto begun = [](const Swarm& s) {
    return s.count([](const Swarm::Client& client) { return client.streamed > 0; }) == kStreams;
  };
  ASSERT_TRUE(swarm.run(begun, test::kPatience));
  RawClient download(server.port());  // a file under way, too
  download.send("GET /v1/logs/" + store.find("large")->log.digest() +
                "/log HTTP/1.1\r\nHost: a\r\n\r\n");
  ASSERT_TRUE(download.answerBegins());
  ASSERT_EQ(::kill(::getpid(), SIGTERM), 0);
  EXPECT_TRUE(swarm.run(allEnded, test::kPatience));
  EXPECT_TRUE(download.receive().body == log_);
  server.join();
  EXPECT_EQ(swarm.count([&](const Swarm::Client& client) {
    return client.whole(log_) && client.closeCode == 1001;
  }),
            kStreams);
}

TEST_F(EnduranceTest, whoTakesNothingHoldsUpTheEndForTheTimeOfGraceAlone) {
  const MeshStore store = *MeshStore::open(folder_.path() / "logs");
  Timeouts timeouts = lasting();
  timeouts.grace = test::kShort;
  auto server = std::make_unique<test::RunningServer>(
      store, files_.viewer(), ServerOptions{.threads = 2, .timeouts = timeouts});
  Swarm stalled(server->port(), "large", log_, 20, 4 << 10);
  ASSERT_TRUE(server->comesTo("connections_open", 21)) << "and that of who asks";
  server.reset();
  EXPECT_TRUE(stalled.run(allEnded, test::kPatience));
  EXPECT_EQ(stalled.count([&](const Swarm::Client& client) { return client.whole(log_); }), 0u);
}

TEST_F(EnduranceTest, aThousandStalledClientsHoldUpNobodyAndLoseNothing) {
  constexpr std::size_t kStalled = 1000, kOthers = 10;
  const char* wanted = std::getenv("QTET_STALL_SECONDS");
  const auto stall = std::chrono::seconds(wanted != nullptr ? std::atoi(wanted) : 2);
  Program program(words());
  const std::uint16_t port = program.port();
  ASSERT_NE(port, 0);
  const std::size_t before = program.residentBytes();
  const auto connected = std::chrono::steady_clock::now();
  Swarm stalled(port, "large", log_, kStalled, 32 << 10);
  ASSERT_EQ(stalled.connected(), kStalled) << "needs 1,100 files (ulimit -n)";
  const auto end = std::chrono::steady_clock::now() + stall;
  std::size_t rounds = 0;
  auto slowest = 0ns;
  do {
    const auto start = std::chrono::steady_clock::now();
    Swarm others(port, "large", log_, kOthers);
    ASSERT_TRUE(others.run(
        [&](const Swarm& s) {
          return s.count([&](const Swarm::Client& client) { return client.done; }) == kOthers;
        },
        test::kPatience));
    EXPECT_EQ(others.count([&](const Swarm::Client& client) { return client.whole(log_); }),
              kOthers);
    slowest = std::max(slowest, std::chrono::steady_clock::now() - start);
    ++rounds;
  } while (std::chrono::steady_clock::now() < end);
  const std::size_t each = (program.residentBytes() - before) / kStalled;
  std::cout << "stalled for " << stall.count() << " s: " << rounds * kOthers << " others streamed "
            << log_.size() << " bytes each, the slowest " << kOthers << " in " << slowest / 1ms
            << " ms; " << each << " bytes of the server's memory a stalled client\n";
  const bool ownProgram =
      std::getenv("QTET_TESTED_SERVER") == nullptr;  // a sanitizer's memory says nothing of ours
  if (ownProgram && !testing::kSanitized) {
    EXPECT_LT(each, 64u << 10);
  }
  // The server cuts a client that stalls for longer than it waits, perhaps because the machine
  // stalled. The others get everything.
  ASSERT_TRUE(stalled.run(
      [&](const Swarm& s) {
        return s.count([](const Swarm::Client& client) { return client.done || client.ended; }) ==
               kStalled;
      },
      3 * test::kPatience));
  EXPECT_EQ(stalled.count([](const Swarm::Client& client) { return client.wrong; }), 0u);
  if (std::chrono::steady_clock::now() - connected < limits::kSilenceTime) {
    EXPECT_EQ(stalled.count([&](const Swarm::Client& client) { return client.whole(log_); }),
              kStalled);
  }
  program.signal(SIGTERM);
  for (Swarm::Client& client : stalled.clients()) ::close(std::exchange(client.socket, -1));
  EXPECT_EQ(program.exitCode(), 0);
}

TEST_F(EnduranceTest, withoutFilesForMoreConnectionsItWaitsWithoutTurningInCirclesAndThenGoesOn) {
  constexpr std::string_view kNoMore = "connections cannot be accepted";
  Program program(words("1"));
  const std::uint16_t port = program.port();
  ASSERT_NE(port, 0);
  const rlimit few{40, 40};
  ASSERT_EQ(::prlimit(program.id(), RLIMIT_NOFILE, &few, nullptr), 0);
  std::vector<std::unique_ptr<RawClient>> clients;
  for (int i = 0; i < 60; ++i) {
    clients.push_back(
        std::make_unique<RawClient>(port));  // the backlog takes those that are not accepted
    clients.back()->send(request());
  }
  EXPECT_EQ(clients.front()->receive().status, 200u);
  EXPECT_TRUE(test::eventually([&] { return program.complaints(kNoMore) == 1; }))
      << "the limit was met";
  const auto told = std::chrono::steady_clock::now();
  const double before = program.cpuSeconds();
  std::this_thread::sleep_for(1s);
  EXPECT_LT(program.cpuSeconds() - before, 0.2) << "it waits, it does not ask again and again";
  EXPECT_TRUE(clients.front()->send(request()));
  EXPECT_EQ(clients.front()->receive().status, 200u) << "who is in is served";
  for (std::size_t i = 0; i < clients.size(); ++i) {
    if (i > 0) {
      EXPECT_EQ(clients[i]->receive().status, 200u) << i;
    }
    clients[i].reset();
  }
  program.signal(SIGTERM);
  EXPECT_EQ(program.exitCode(), 0);
  const auto passed = std::chrono::steady_clock::now() - told;
  EXPECT_LE(program.complaints(kNoMore),
            1u + static_cast<std::size_t>(passed / limits::kAcceptWarningInterval))
      << "and told once, and again where the machine stalled";
}

TEST_F(EnduranceTest, halfOpenConnectionsAreGivenUpAndCostNobodyElseAnything) {
  // A client that vanished without a word looks like one that never answers: no head, no TCP
  // window, no pong.
  const MeshStore store = *MeshStore::open(folder_.path() / "logs");
  test::RunningServer server(store, files_.viewer(),
                             {.timeouts = {.header = test::kShort,
                                           .idle = test::kShort,
                                           .write = test::kShort,
                                           .silence = 2 * test::kShort}});
  Swarm vanished(server.port(), "large", log_, 20, 4 << 10);
  for (Swarm::Client& client : vanished.clients()) client.reads = false;
  RawClient silent(server.port());
  EXPECT_TRUE(silent.closedByServer());
  const auto halfAHead = [&] {
    RawClient half(server.port());
    return half.send("GET / HTTP/1.1\r\nHo") && half.receive().status == 408;
  };
  EXPECT_TRUE(test::eventually(halfAHead));
  EXPECT_TRUE(test::eventually(
      [&] { return RawClient(server.port()).get("/v1/meshes/large").status == 200; }));
  EXPECT_TRUE(server.comesTo("connections_open", 1)) << "that of who asks";
  for (Swarm::Client& client : vanished.clients())
    client.reads = true;  // what is left in the system's buffers, and the end
  EXPECT_TRUE(vanished.run(allEnded, test::kPatience));
  EXPECT_EQ(vanished.count([](const Swarm::Client& client) { return client.wrong; }), 0u);
  EXPECT_EQ(vanished.count([&](const Swarm::Client& client) { return client.done; }), 0u);
}

TEST_F(EnduranceTest, aStreamThatSaysNothingIsToldWhyItEnds) {
  const MeshStore store = *MeshStore::open(folder_.path() / "logs");
  test::RunningServer server(store, files_.viewer(), {.timeouts = {.silence = 2 * test::kShort}});
  RawClient silent(server.port());
  silent.send(
      "GET /v1/stream HTTP/1.1\r\nHost: a\r\nConnection: Upgrade\r\nUpgrade: websocket\r\n"
      "Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n"
      "Sec-WebSocket-Protocol: qtet.v1\r\n\r\n");
  const std::string all = silent.readToEnd();
  EXPECT_TRUE(all.ends_with("\x03\xF0no message and no pong came for too long")) << all;
}

}  // namespace
}  // namespace qtet
