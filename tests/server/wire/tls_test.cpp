// HTTP and WebSocket over TLS in the server's own process.
#include <gtest/gtest.h>
#include <openssl/ssl.h>
#include <openssl/sslerr.h>

#include <atomic>
#include <csignal>
#include <thread>
#include <vector>

#include "server/wire/tls_context.h"
#include "tests/server/program/loopback.h"
#include "tests/server/program/program.h"
#include "tests/server/program/served_folder.h"
#include "tests/server/wire/tls_client.h"

namespace qtet {
namespace {

using test::TlsChoice;
using test::TlsClient;

class TlsTest : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!test::makeCertificate(folder_.path(), "a") || !test::makeCertificate(folder_.path(), "b"))
      GTEST_SKIP() << "there is no openssl program";
    const auto log =
        test::makeLog({.chunks = 60, .fields = {}, .largestBlock = 200'000, .seed = 9});
    large_.assign(log.begin(), log.end());
    folder_.write("logs/large.qtet", ByteView(log));
    store_ = *MeshStore::open(folder_.path() / "logs");
    tls_.emplace(*TlsContext::load(file("a.crt"), file("a.key")));
    server_.emplace(store_, files_.viewer(),
                    ServerOptions{.threads = 2, .timeouts = {.header = header()}, .tls = &*tls_});
  }
  [[nodiscard]] virtual std::chrono::milliseconds header() const { return test::kNever; }
  [[nodiscard]] std::filesystem::path file(const std::string& name) const {
    return folder_.path() / name;
  }
  [[nodiscard]] std::uint16_t port() const { return server_->port(); }

  test::TempFolder folder_;
  test::ServedFolder files_;  // for the viewer's
  MeshStore store_;
  std::string large_;
  std::optional<CurrentTls> tls_;
  std::optional<test::RunningServer> server_;
};

TEST_F(TlsTest, wholeFilesRangesLevelsAndPagesComeOverEveryVersionThatIsSpoken) {
  const std::string log = "/v1/logs/" + store_.find("large")->log.digest() + "/log";
  for (const int version : {TLS1_2_VERSION, TLS1_3_VERSION}) {
    TlsClient client(port(), file("a.crt"),
                     {.least = version, .most = version, .alpn = "\x02h2\x08http/1.1"});
    ASSERT_TRUE(client.connected());
    EXPECT_EQ(client.version(), version == TLS1_2_VERSION ? "TLSv1.2" : "TLSv1.3");
    EXPECT_EQ(client.alpn(), "http/1.1");
    EXPECT_EQ(client.get("/v1/meshes/large/none"), "");
    EXPECT_NE(client.get("/v1/meshes").find("large"), std::string::npos);
    EXPECT_NE(client.get("/").find("viewer"), std::string::npos);
    EXPECT_EQ(client.get(log, "Range: bytes=100000-299999\r\n"), large_.substr(100'000, 200'000));
    EXPECT_TRUE(client.get(log) == large_);
    client.shutdown();
  }
}

TEST_F(TlsTest, aClientThatReadsSlowlyLosesNothing) {
  TlsClient client(port(), file("a.crt"));
  const std::string request =
      "GET /v1/logs/" + store_.find("large")->log.digest() + "/log HTTP/1.1\r\nHost: a\r\n\r\n";
  ASSERT_TRUE(client.send(request + request));  // the second comes while the first is being written
  for (int i = 0; i < 2; ++i) {
    std::this_thread::sleep_for(test::kQuiet);  // the server's buffers are full by now
    std::string head;
    while (!head.ends_with("\r\n\r\n")) {
      const std::string byte = client.read(1);
      ASSERT_FALSE(byte.empty());
      head += byte;
    }
    EXPECT_TRUE(client.read(large_.size()) == large_);
  }
}

TEST_F(TlsTest, oldVersionsAreRefused) {
  for (const int version : {TLS1_VERSION, TLS1_1_VERSION})
    EXPECT_FALSE(TlsClient(port(), file("a.crt"), {.least = version, .most = version}).connected());
  EXPECT_TRUE(
      TlsClient(port(), file("a.crt"), {.least = TLS1_VERSION, .most = TLS1_2_VERSION}).connected())
      << "the same client, but for the version";
}

TEST_F(TlsTest, whoOffersOtherProtocolsAloneIsToldSoByTheAlert) {
  for (const int version : {TLS1_2_VERSION, TLS1_3_VERSION})
    for (const std::string alpn : {"\x02h2", "\x02h2\x08http/1.0"}) {
      const TlsClient client(port(), file("a.crt"),
                             {.least = version, .most = version, .alpn = alpn});
      EXPECT_FALSE(client.connected()) << alpn;
      EXPECT_EQ(client.refusal(), SSL_R_TLSV1_ALERT_NO_APPLICATION_PROTOCOL) << alpn;
    }
  TlsClient without(port(), file("a.crt"));
  EXPECT_EQ(without.alpn(), "");
  EXPECT_NE(without.get("/v1/meshes").find("large"), std::string::npos);
}

TEST_F(TlsTest, theFiguresTellWhenTheCertificateEnds) {
  TlsClient client(port(), file("a.crt"));
  const std::string metrics = client.get("/metrics");
  const std::string name = "\nqtet_tls_certificate_expiry_timestamp_seconds ";
  const std::size_t at = metrics.find(name);
  ASSERT_NE(at, std::string::npos) << metrics;
  const auto now =
      std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch());
  const double days = (std::stod(metrics.substr(at + name.size())) - now.count()) / 86'400;
  EXPECT_GT(days, 0);
  EXPECT_LT(days, 3651);
}

TEST_F(TlsTest, aStreamBringsTheLogByteForByte) {
  TlsClient client(port(), file("a.crt"));
  EXPECT_TRUE(client.stream("large") == large_);
}

TEST_F(TlsTest, aNewCertificateIsForNewConnectionsAndEndsNoOldOne) {
  TlsClient before(port(), file("a.crt"));
  ASSERT_TRUE(before.connected());
  EXPECT_FALSE(TlsClient(port(), file("b.crt")).connected());
  tls_->replace(*TlsContext::load(file("b.crt"), file("b.key")));
  EXPECT_TRUE(TlsClient(port(), file("b.crt")).connected());
  EXPECT_FALSE(TlsClient(port(), file("a.crt")).connected());
  EXPECT_NE(before.get("/v1/meshes").find("large"), std::string::npos);
}

TEST_F(TlsTest, theProgramSpeaksItAndReadsItsCertificateAgainOnSighup) {
  const std::vector<std::string> words = {folder_.path() / "logs",
                                          "--port",
                                          "0",
                                          "--viewer",
                                          files_.viewerFolder(),
                                          "--tls-certificate",
                                          file("live.crt"),
                                          "--tls-key",
                                          file("live.key")};
  const auto use = [&](const std::string& name) {
    for (const char* ending : {".crt", ".key"})
      std::filesystem::copy_file(file(name + ending), file(std::string("live") + ending),
                                 std::filesystem::copy_options::overwrite_existing);
  };
  use("a");
  test::Program program(words);
  const std::uint16_t port = program.port();
  ASSERT_NE(port, 0);
  TlsClient before(port, file("a.crt"));
  EXPECT_NE(before.get("/v1/meshes").find("large"), std::string::npos);
  use("b");
  program.signal(SIGHUP);
  EXPECT_TRUE(test::eventually([&] { return TlsClient(port, file("b.crt")).connected(); }));
  folder_.write("live.key", std::string_view("nonsense"));
  program.signal(SIGHUP);
  EXPECT_TRUE(test::eventually([&] { return program.complaints("are kept") == 1; }));
  EXPECT_TRUE(TlsClient(port, file("b.crt")).connected()) << "what was sound holds on";
  EXPECT_NE(before.get("/v1/meshes").find("large"), std::string::npos)
      << "the old connection goes on";
  program.signal(SIGTERM);
  EXPECT_EQ(program.exitCode(), 0);
  test::Program half({folder_.path() / "logs", "--tls-key", file("a.key")});
  EXPECT_NE(half.errors().find("--tls-certificate and --tls-key"), std::string::npos);
  EXPECT_EQ(half.exitCode(), 2);
}

TEST_F(TlsTest, whatIsNoPairIsNamed) {
  ASSERT_EQ(std::system(("openssl ec -aes128 -passout pass:secret -in '" + file("a.key").string() +
                         "' -out '" + file("locked.key").string() + "' 2> /dev/null")
                            .c_str()),
            0);
  folder_.write("text", std::string_view("nonsense"));
  for (const auto& [certificate, key, named] : {std::tuple("a.crt", "b.key", "b.key"),
                                                {"a.crt", "locked.key", "locked.key"},
                                                {"a.crt", "missing", "missing"},
                                                {"missing", "a.key", "missing"},
                                                {"text", "a.key", "text"},
                                                {"a.crt", "text", "text"}}) {
    const auto refused = TlsContext::load(file(certificate), file(key));
    ASSERT_FALSE(refused) << certificate << " " << key;
    EXPECT_TRUE(refused.error().message.starts_with(file(named).string()))
        << refused.error().message;
  }
}

TEST_F(TlsTest, aKeyOfAnotherKindThanItsCertificateIsRefused) {
  ASSERT_TRUE(test::makeCertificate(folder_.path(), "rsa", "rsa:2048"));
  EXPECT_TRUE(TlsContext::load(file("rsa.crt"), file("rsa.key")));
  for (const auto& [certificate, key] :
       {std::pair("a.crt", "rsa.key"), std::pair("rsa.crt", "a.key")}) {
    const auto refused = TlsContext::load(file(certificate), file(key));
    ASSERT_FALSE(refused) << certificate << " " << key;
    EXPECT_TRUE(refused.error().message.starts_with(file(key).string() + " holds a key, but not"))
        << refused.error().message;
    test::Program check({(folder_.path() / "logs").string(), "--check-config", "--tls-certificate",
                         file(certificate), "--tls-key", file(key)});
    EXPECT_EQ(check.exitCode(), 1);
  }
}

TEST_F(TlsTest, everyAnswerSaysThatPlainHttpIsOver) {
  TlsClient client(port(), file("a.crt"));
  ASSERT_TRUE(client.send("GET /livez HTTP/1.1\r\nHost: a\r\n\r\n"));
  EXPECT_EQ(client.receive().header("strict-transport-security"), "max-age=31536000");
  test::RunningServer plain(store_, files_.viewer());
  EXPECT_EQ(test::RawClient(plain.port()).get("/livez").header("strict-transport-security"), "");
}

TEST_F(TlsTest, whoSpeaksPlainHttpIsTold) {
  test::RawClient plain(port());
  const test::HttpResponse answer = plain.get("/v1/meshes");
  EXPECT_EQ(answer.status, 400u);
  EXPECT_NE(answer.body.find("https://"), std::string::npos);
  EXPECT_TRUE(plain.closedByServer());
}

/// With little time for a handshake.
class HastyTlsTest : public TlsTest {
 protected:
  [[nodiscard]] std::chrono::milliseconds header() const override { return test::kShort; }
};

TEST_F(HastyTlsTest, whoSaysNothingOrNonsenseIsGivenUp) {
  test::RawClient nonsense(port()), silent(port()), half(port());
  nonsense.send("nonsense nonsense nonsense");
  half.send(std::string("\x16\x03\x01\x02\x00\x01", 6));
  (void)nonsense.readToEnd();
  EXPECT_TRUE(half.cutByServer());
  EXPECT_TRUE(silent.closedByServer());
  EXPECT_TRUE(test::eventually([&] { return TlsClient(port(), file("a.crt")).connected(); }));
}

TEST_F(TlsTest, aHelloThatAnnouncesTooMuchIsCutOffAtItsHead) {
  // of the three bytes of its length
  const auto helloOf = [](unsigned char high, unsigned char middle) {
    return std::string({'\x16', '\x03', '\x01', '\x20', '\x00', '\x01', static_cast<char>(high),
                        static_cast<char>(middle), '\x00'});
  };
  test::RawClient sound(port()), tooLong(port());
  sound.send(helloOf(0, 0x20));
  tooLong.send(helloOf(1, 0));
  EXPECT_TRUE(tooLong.cutByServer());
  EXPECT_FALSE(sound.hasAnswer()) << "the rest of a sound one is waited for";
}

TEST_F(TlsTest, aKeyMayChangeOftenButNotForEverWithoutAByteOfData) {
  constexpr int kMax = 32;  // client_socket.cpp, kMaxKeyUpdates
  const TlsChoice choice{.least = TLS1_3_VERSION};
  TlsClient client(port(), file("a.crt"), choice);
  for (int i = 0; i < 3; ++i) {
    client.updateKey(kMax);
    EXPECT_NE(client.get("/v1/meshes").find("large"), std::string::npos);
  }
  client.updateKey(kMax + 1);
  EXPECT_EQ(client.get("/v1/meshes"), "") << "cut off before the request is read";
  EXPECT_NE(TlsClient(port(), file("a.crt"), choice).get("/v1/meshes").find("large"),
            std::string::npos);
}

/// With one place for handshakes.
class NarrowTlsTest : public TlsTest {
 protected:
  void begin(std::chrono::milliseconds patience, std::size_t places = 1,
             std::size_t ofAddress = limits::kMaxHandshakesPerAddress) {
    server_.emplace(
        store_, files_.viewer(),
        ServerOptions{
            .threads = 2,
            .maxHandshakes = places,
            .maxHandshakesPerAddress = ofAddress,
            .timeouts = {.header = test::kNever, .handshake = patience, .grace = test::kNever},
            .adminHost = "127.0.0.1",
            .tls = &*tls_});
    stalled_.emplace(port(), kOtherAddress);
    stalled_->send(test::clientHello());
    wait("tls_handshakes_open 1");
  }
  void wait(const std::string& line) {
    ASSERT_TRUE(test::eventually([&] {
      return figures().find("qtet_" + line + "\n") != std::string::npos;
    })) << line
        << "\n"
        << figures();
  }
  [[nodiscard]] std::string figures() const {
    return test::RawClient(server_->adminPort()).get("/metrics").body;
  }

  static constexpr const char* kOtherAddress = "127.0.0.2";
  std::optional<test::RawClient> stalled_;  ///< has the place and does not go on
};

TEST_F(NarrowTlsTest, whoeverFindsNoPlaceForAHandshakeWaitsForOne) {
  begin(std::chrono::hours(1));
  std::vector<std::jthread> others;
  std::atomic<int> served = 0;
  for (int i = 0; i < 3; ++i)
    others.emplace_back(
        [&] { served += !TlsClient(port(), file("a.crt")).get("/v1/meshes").empty(); });
  wait("tls_handshakes_waiting 3");
  EXPECT_EQ(served, 0);
  stalled_.reset();
  others.clear();
  EXPECT_EQ(served, 3);
  wait("tls_handshakes_open 0");
  wait("tls_handshakes_waiting 0");
  wait("tls_handshakes_displaced_total 0");
}

TEST_F(NarrowTlsTest, aHandshakeThatStallsLosesItsPlaceToWhoeverWaits) {
  begin(std::chrono::milliseconds(100));
  EXPECT_FALSE(TlsClient(port(), file("a.crt")).get("/v1/meshes").empty());
  wait("tls_handshakes_displaced_total 1");
  EXPECT_NE(stalled_->readToEnd(), "") << "the server's answer to its hello; then the end";
}

TEST_F(NarrowTlsTest, anAddressThatStallsLeavesThePlacesOfOthers) {
  begin(std::chrono::hours(1), 2, 1);
  test::RawClient second(port(), kOtherAddress);
  second.send(test::clientHello());
  wait("tls_handshakes_waiting 1");
  EXPECT_FALSE(TlsClient(port(), file("a.crt")).get("/v1/meshes").empty());
  stalled_.reset();
  EXPECT_TRUE(second.answerBegins());
}

TEST_F(NarrowTlsTest, theServersEndIsNotHeldUpByThoseWhoWait) {
  begin(std::chrono::hours(1));
  test::RawClient second(port());
  second.send(test::clientHello());
  wait("tls_handshakes_waiting 1");
  server_.reset();
  EXPECT_EQ(second.readToEnd(), "");
}

}  // namespace
}  // namespace qtet
