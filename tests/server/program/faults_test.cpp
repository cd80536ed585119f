// Tests the program while its system calls fail: every N-th of a kind, a full disk, a jumping
// system clock. Each answer is right or reports that something is missing. Nothing dies, and all
// works again once the faults stop.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <thread>

#include "proto/checksum.h"
#include "tests/server/program/loopback.h"
#include "tests/server/program/program.h"
#include "tests/server/program/served_folder.h"
#include "tests/server/stream/swarm.h"
#include "tests/server/support/json.h"
#include "tests/server/wire/tls_client.h"
#include "tests/support/faults/fault_plan.h"
#include "tests/support/paths/test_paths.h"
#include "tests/support/sample_log.h"
#include "tests/support/written_log.h"

namespace qtet {
namespace {

using namespace std::chrono_literals;
using test::Fault;
using test::FaultPlan;
using test::HttpResponse;
using test::Program;
using test::RawClient;
using test::Swarm;
using test::TlsClient;

const std::string kToken = "aSecretOfTwentyTwoChars";

class FaultsTest : public ::testing::Test {
 protected:
  explicit FaultsTest(bool tls = false) : tls_(tls) {
    const auto bytes =
        test::makeLog({.chunks = 12, .fields = {}, .largestBlock = 60'000, .seed = 4});
    log_.assign(bytes.begin(), bytes.end());
    folder_.write("logs/large.qtet", ByteView(bytes));
    std::filesystem::copy_file(testing::sampleLog(), logs() / "solid.qtet");
    folder_.write("tokens", std::string_view("write * " + kToken + "\nread [!z]* anyone\n"));
    const std::string plan = folder_.path() / "plan";
    const int file = ::open(plan.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600);
    if (file < 0 || ::ftruncate(file, sizeof(FaultPlan)) != 0) throw std::runtime_error("no plan");
    plan_ = static_cast<FaultPlan*>(
        ::mmap(nullptr, sizeof(FaultPlan), PROT_READ | PROT_WRITE, MAP_SHARED, file, 0));
    ::close(file);
    std::vector<std::string> words = {logs(),
                                      "--port",
                                      "0",
                                      "--threads",
                                      "2",
                                      "--viewer",
                                      files_.viewerFolder(),
                                      "--max-connections-per-address",
                                      "0",
                                      "--tokens",
                                      folder_.path() / "tokens",
                                      "--cache",
                                      folder_.path() / "cache"};
    if (tls_ && test::makeCertificate(folder_.path(), "a"))
      words.insert(words.end(),
                   {"--tls-certificate", certificate(), "--tls-key", folder_.path() / "a.key"});
    program_ = std::make_unique<Program>(
        words, std::vector<std::string>{std::string("LD_PRELOAD=") + testing::kFaultsLibrary,
                                        "QTET_FAULTS=" + plan});
    port_ = program_->port();
    digest_ = sha256Hex({reinterpret_cast<const std::uint8_t*>(log_.data()), log_.size()});
  }
  ~FaultsTest() override { ::munmap(plan_, sizeof(FaultPlan)); }

  /// One that may be uploaded.
  [[nodiscard]] static std::string soundLog(std::uint32_t seed) {
    const Bytes bytes = testing::logBytes(testing::soundMesh(6, seed));
    return {bytes.begin(), bytes.end()};
  }
  [[nodiscard]] std::filesystem::path logs() const { return folder_.path() / "logs"; }
  [[nodiscard]] std::filesystem::path certificate() const { return folder_.path() / "a.crt"; }
  void fail(Fault fault, std::uint32_t every, int error = 0) {
    plan_->of(fault).error = error;
    plan_->of(fault).every = every;
  }
  void stopFaults() {
    for (FaultPlan::Kind& kind : plan_->kinds) kind.every = 0;
  }
  /// On a connection of its own.
  HttpResponse ask(const std::string& head, const std::string& body = "") {
    const auto askBy = [&](auto&& client) {
      client.send(head + "\r\n");
      client.send(body);
      return client.receive();
    };
    return tls_ ? askBy(TlsClient(port_, certificate())) : askBy(RawClient(port_));
  }
  HttpResponse get(const std::string& target) {
    return ask("GET " + target + " HTTP/1.1\r\nHost: localhost\r\n");
  }
  HttpResponse put(const std::string& id, const std::string& body) {
    return ask("PUT /v1/meshes/" + id + " HTTP/1.1\r\nHost: a\r\nAuthorization: Bearer " + kToken +
                   "\r\nContent-Length: " + std::to_string(body.size()) + "\r\n",
               body);
  }
  /// Nothing, the right bytes, or the server's word that it cannot.
  void expectRightOrTold(const HttpResponse& reply, const std::string& right,
                         const std::string& what) {
    if (reply.status == 200) {
      EXPECT_TRUE(reply.body == right) << what << ": wrong bytes";
      ++whole_;
    } else {
      EXPECT_TRUE(reply.status == 0 || reply.status >= 500)
          << what << ": " << reply.status << " " << reply.body;
    }
  }
  void stream() {
    if (tls_) {
      const std::string streamed = TlsClient(port_, certificate()).stream("large");
      EXPECT_TRUE(log_.starts_with(streamed)) << "wrong bytes";
      whole_ += streamed == log_;
      return;
    }
    Swarm swarm(port_, "large", log_, 4);
    swarm.run(
        [](const Swarm& s) {
          return s.count([](const Swarm::Client& client) { return client.done || client.ended; }) ==
                 4;
        },
        test::kPatience);
    EXPECT_EQ(swarm.count([](const Swarm::Client& client) { return client.wrong; }), 0u);
    whole_ += swarm.count([&](const Swarm::Client& client) { return client.whole(log_); });
  }
  void load() {
    const std::string log = "/v1/logs/" + digest_;
    for (int round = 0; round < 12; ++round) {
      expectRightOrTold(get(log + "/log"), log_, "log");
      expectRightOrTold(get("/v1/meshes/large"), description_, "description");
      expectRightOrTold(get(level_), vtu_, "level");
      stream();
      const HttpResponse uploaded = put("up" + std::to_string(round % 3), sound_);
      // 408: the server did not receive the body.
      EXPECT_TRUE(uploaded.status == 0 || uploaded.status == 200 || uploaded.status == 201 ||
                  uploaded.status == 408 || uploaded.status >= 500)
          << uploaded.status << uploaded.body;
      ASSERT_TRUE(program_->runs());
    }
  }
  void everyNthFails(Fault fault) {
    for (const std::uint32_t every : {2u, 3u, 7u}) {
      fail(fault, every);
      load();
      stopFaults();
    }
    EXPECT_GT(plan_->of(fault).failed, 3u) << "the faults took place";
    EXPECT_GT(whole_, 0u) << "some got through";
    expectAllWell();
  }
  /// Everything is to be had, and right.
  void expectAllWell() {
    folder_.write("logs/touched.txt", std::string_view("the folder is looked at again"));
    EXPECT_TRUE(test::eventually([&] { return get("/v1/meshes/solid").status == 200; }));
    EXPECT_TRUE(get("/v1/logs/" + digest_ + "/log").body == log_);
    EXPECT_EQ(get("/v1/meshes/large").body, description_);
    EXPECT_TRUE(get(level_).body == vtu_);
    EXPECT_EQ(put("up-after", sound_).status, 201u);
    EXPECT_TRUE(get("/v1/meshes/up-after").status == 200);
    if (tls_) {
      EXPECT_TRUE(TlsClient(port_, certificate()).stream("large") == log_);
      return;
    }
    Swarm swarm(port_, "large", log_, 8);
    EXPECT_TRUE(swarm.run(
        [](const Swarm& s) {
          return s.count([](const Swarm::Client& client) { return client.done; }) == 8;
        },
        test::kPatience));
    EXPECT_EQ(swarm.count([&](const Swarm::Client& client) { return client.whole(log_); }), 8u);
  }
  void SetUp() override {
    if (tls_ && !std::filesystem::exists(certificate()))
      GTEST_SKIP() << "there is no openssl program";
    ASSERT_NE(port_, 0) << program_->errors();
    description_ = get("/v1/meshes/large").body;
    level_ = get("/v1/meshes/solid/levels/1.vtu").header("location");
    vtu_ = get(level_).body;
    ASSERT_GT(vtu_.size(), 1000u);
  }
  void TearDown() override {
    program_->signal(SIGTERM);
    EXPECT_EQ(program_->exitCode(), 0);
  }

  const bool tls_;
  test::TempFolder folder_;
  test::ServedFolder files_;  // for the viewer's
  FaultPlan* plan_ = nullptr;
  std::unique_ptr<Program> program_;
  std::uint16_t port_ = 0;
  std::string log_, digest_, description_, level_, vtu_;
  const std::string sound_ = soundLog(6);
  std::size_t whole_ = 0;  ///< answers that came whole
};

class EveryNthFails : public FaultsTest,
                      public ::testing::WithParamInterface<std::pair<Fault, const char*>> {};

TEST_P(EveryNthFails, andWhatComesIsRightAndAllIsWellAfterwards) {
  everyNthFails(GetParam().first);
}

INSTANTIATE_TEST_SUITE_P(
    Calls, EveryNthFails,
    ::testing::Values(std::pair(Fault::kReceive, "receive"), std::pair(Fault::kSend, "send"),
                      std::pair(Fault::kSendFile, "sendfile"), std::pair(Fault::kAccept, "accept"),
                      std::pair(Fault::kOpen, "open"), std::pair(Fault::kMap, "mmap"),
                      std::pair(Fault::kWriteFile, "write")),
    [](const auto& kind) { return kind.param.second; });

/// OpenSSL reads and writes the sockets itself.
class EveryNthFailsOverTls : public FaultsTest,
                             public ::testing::WithParamInterface<std::pair<Fault, const char*>> {
 protected:
  EveryNthFailsOverTls() : FaultsTest(true) {}
};

TEST_P(EveryNthFailsOverTls, andWhatComesIsRightAndAllIsWellAfterwards) {
  everyNthFails(GetParam().first);
}

INSTANTIATE_TEST_SUITE_P(Calls, EveryNthFailsOverTls,
                         ::testing::Values(std::pair(Fault::kReceive, "receive"),
                                           std::pair(Fault::kSend, "send"),
                                           std::pair(Fault::kAccept, "accept")),
                         [](const auto& kind) { return kind.param.second; });

TEST_F(FaultsTest, everythingFailsNowAndThenAtOnce) {
  std::uint32_t every = 5;
  for (std::size_t i = 0; i < test::kFaults; ++i) fail(static_cast<Fault>(i), every += 2);
  load();
  stopFaults();
  EXPECT_GT(whole_, 0u);
  expectAllWell();
}

TEST_F(FaultsTest, aFullDiskRefusesAnUploadAndLeavesWhatWasThere) {
  EXPECT_EQ(put("kept", sound_).status, 201u);
  const std::string before = get("/v1/meshes/kept").header("etag");
  fail(Fault::kWriteFile, 1, ENOSPC);
  const std::string other = soundLog(5);
  const HttpResponse refused = put("kept", other);
  EXPECT_EQ(refused.status, 507u) << refused.body;
  EXPECT_EQ(get("/v1/meshes/kept").header("etag"), before);
  EXPECT_EQ(put("new", other).status, 507u);
  const std::string digest =
      sha256Hex({reinterpret_cast<const std::uint8_t*>(other.data()), other.size()});
  EXPECT_EQ(put("new?digest=" + digest, other).status, 507u) << "and its part goes";
  EXPECT_EQ(get("/v1/meshes/new").status, 404u);
  EXPECT_EQ(get("/v1/logs/" + digest_ + "/log").body, log_) << "reading goes on";
  for (const auto& entry : std::filesystem::directory_iterator(logs()))
    EXPECT_NE(entry.path().extension(), ".part") << entry.path();
  stopFaults();
  EXPECT_EQ(put("kept", other).status, 200u);
}

TEST_F(FaultsTest, theSystemsClockMayJumpAndEndsNothingAndHoldsNothing) {
  RawClient kept(port_);
  const std::string today = kept.get("/livez").header("date");
  Swarm swarm(port_, "large", log_, 2, 4 << 10);
  ASSERT_TRUE(swarm.run(
      [](const Swarm& s) {
        return s.count([](const Swarm::Client& client) { return client.streamed > 0; }) == 2;
      },
      test::kPatience));
  RawClient poster(port_);
  poster.send("POST /v1/tickets HTTP/1.1\r\nHost: a\r\nAuthorization: Bearer " + kToken +
              "\r\nContent-Length: 0\r\n\r\n");
  const std::string ticket = test::Json::parse(poster.receive().body)["ticket"].string();
  constexpr std::int64_t kYears = 20LL * 366 * 86400;
  for (const std::int64_t shift : {kYears, -kYears, std::int64_t{0}}) {
    plan_->clockShift = shift;
    const HttpResponse reply = kept.get("/livez");
    EXPECT_EQ(reply.status, 200u) << "an idle connection stays";
    EXPECT_EQ(reply.header("date").substr(12, 4) == today.substr(12, 4), shift == 0)
        << "the clock has jumped: " << reply.header("date");
    EXPECT_EQ(put("up", sound_).status < 300, true);
    std::this_thread::sleep_for(50ms);
  }
  plan_->clockShift = kYears;
  EXPECT_TRUE(test::StreamClient(port_, "qtet.v1", "/v1/stream?ticket=" + ticket).connected());
  EXPECT_TRUE(swarm.run(
      [](const Swarm& s) {
        return s.count([](const Swarm::Client& client) { return client.done; }) == 2;
      },
      test::kPatience));
  EXPECT_EQ(swarm.count([&](const Swarm::Client& client) { return client.whole(log_); }), 2u);
}

}  // namespace
}  // namespace qtet
