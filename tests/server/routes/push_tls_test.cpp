// `qtet push` over https against a real server, and what it refuses to talk to.
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <signal.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <optional>

#include "proto/checksum.h"
#include "server/wire/tls_context.h"
#include "tests/server/program/loopback.h"
#include "tests/server/program/served_folder.h"
#include "tests/server/routes/push_run.h"
#include "tests/server/wire/tls_client.h"
#include "tests/support/meshes.h"
#include "tests/support/paths/test_paths.h"
#include "tests/support/written_log.h"

namespace qtet {
namespace {

class PushTlsTest : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!test::makeCertificate(mine_.path(), "a") || !test::makeCertificate(mine_.path(), "b"))
      GTEST_SKIP() << "there is no openssl program";
    mine_.write("wing.qtet", log_);
    serve();
  }
  /// With a.crt as it is now.
  void serve() {
    server_.reset();
    tls_.emplace(*TlsContext::load(mine_.path() / "a.crt", mine_.path() / "a.key"));
    server_.emplace(*store_, folder_.viewer(), ServerOptions{.tls = &*tls_, .access = &access_});
  }
  /// Over https to `host`, with the shell's `words`.
  test::PushOutcome push(const std::string& words, const std::string& host = "localhost") {
    return test::runPush(mine_.path() / "wing.qtet",
                         "https://" + host + ":" + std::to_string(server_->port()) + "/ " + words);
  }
  std::string trusting(const std::string& name) const {
    return "--cacert '" + (mine_.path() / name).string() + "'";
  }
  /// That it gave up at once, for `reason`, and nothing was sent.
  void expectRefusal(const test::PushOutcome& pushed, const std::string& reason) {
    EXPECT_EQ(pushed.code, 1);
    EXPECT_NE(pushed.text.find(reason), std::string::npos) << pushed.text;
    EXPECT_EQ(pushed.text.find("trying again"), std::string::npos) << pushed.text;
    EXPECT_FALSE(std::filesystem::exists(folder_.logFolder() / "wing.qtet"));
  }

  test::ServedFolder folder_;
  test::TempFolder mine_;
  const Bytes log_ = testing::logBytes(testing::soundMesh(8, 99));
  Access access_{*Tokens::parse(std::string("write * ") + test::kPushToken)};
  std::unique_ptr<MeshStore> store_ =
      std::make_unique<MeshStore>(*MeshStore::open(folder_.logFolder()));
  std::optional<CurrentTls> tls_;
  std::optional<test::RunningServer> server_;
};

TEST_F(PushTlsTest, aLogArrivesWhereTheCertificateHolds) {
  const test::PushOutcome pushed = push(trusting("a.crt"));
  EXPECT_EQ(pushed.code, 0) << pushed.text;
  EXPECT_NE(pushed.text.find("https://localhost:"), std::string::npos) << pushed.text;
  test::TlsClient client(server_->port(), mine_.path() / "a.crt");
  EXPECT_EQ(client.get("/v1/logs/" + sha256Hex(log_) + "/log"),
            std::string(log_.begin(), log_.end()));
}

TEST_F(PushTlsTest, aCertificateOfAnotherAuthorityIsRefused) {
  expectRefusal(push(trusting("b.crt")), "does not hold");
  expectRefusal(push(""), "--cacert");
}

TEST_F(PushTlsTest, aCertificateOfAnotherHostIsRefused) {
  expectRefusal(push(trusting("a.crt"), "127.0.0.1"), "does not hold");
}

TEST_F(PushTlsTest, anExpiredCertificateIsRefused) {
  ASSERT_TRUE(test::expireCertificate(mine_.path(), "a"));
  serve();
  expectRefusal(push(trusting("a.crt")), "expired");
}

TEST_F(PushTlsTest, aFileThatHoldsNoAuthoritiesIsNamed) {
  expectRefusal(push(trusting("none.crt")), "none.crt");
  expectRefusal(push(trusting("wing.qtet")), "wing.qtet");
}

/// Takes connections, and neither reads nor says anything.
class MuteServer {
 public:
  MuteServer() : socket_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof(address);
    ::bind(socket_, reinterpret_cast<const sockaddr*>(&address), size);
    ::listen(socket_, 8);
    ::getsockname(socket_, reinterpret_cast<sockaddr*>(&address), &size);
    port_ = ntohs(address.sin_port);
  }
  ~MuteServer() { ::close(socket_); }
  MuteServer(const MuteServer&) = delete;
  MuteServer& operator=(const MuteServer&) = delete;

  [[nodiscard]] std::uint16_t port() const { return port_; }
  /// Waits for a client and its first bytes, which it leaves; its socket, or -1.
  [[nodiscard]] int awaitClient() const {
    const int client = ::accept4(socket_, nullptr, nullptr, SOCK_CLOEXEC);
    char byte = 0;
    return ::recv(client, &byte, 1, MSG_PEEK) == 1 ? client : -1;
  }

 private:
  int socket_;
  std::uint16_t port_ = 0;
};

TEST_F(PushTlsTest, aPushToAServerThatHangsEndsWithCtrlC) {
  for (const std::string scheme : {"http", "https"}) {
    const MuteServer server;
    const std::string url = scheme + "://localhost:" + std::to_string(server.port()) + "/";
    const std::string log = (mine_.path() / "wing.qtet").string();
    std::string words[] = {testing::kTool, "push", log, url, "--quiet"};
    char* arguments[] = {words[0].data(), words[1].data(), words[2].data(),
                         words[3].data(), words[4].data(), nullptr};
    std::string token = std::string("QTET_TOKEN=") + test::kPushToken;
    char* environment[] = {token.data(), nullptr};
    pid_t child = -1;
    ASSERT_EQ(::posix_spawn(&child, testing::kTool, nullptr, nullptr, arguments, environment), 0);
    const int client = server.awaitClient();
    EXPECT_GE(client, 0);
    ::kill(child, SIGINT);
    int status = 0;
    EXPECT_TRUE(test::eventually([&] { return ::waitpid(child, &status, WNOHANG) == child; }));
    EXPECT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == SIGINT) << status;
    ::close(client);
  }
}

}  // namespace
}  // namespace qtet
