// Clients that come through a proxy which the server trusts, or through one that it does not.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include "tests/server/program/loopback.h"
#include "tests/server/program/served_folder.h"
#include "tests/server/support/json.h"

namespace qtet {
namespace {

using test::Json;

class Proxies : public ::testing::Test {
 protected:
  /// A server that trusts 127.0.0.1, or `networks`, and lets an address ask once a second, twice
  /// at once.
  test::RunningServer serve(ProxyHeader header, const char* networks = "127.0.0.0/8") {
    return test::RunningServer(folder_.store(), folder_.viewer(),
                               {.maxConnectionsPerAddress = 1,
                                .maxRequestsPerSecond = 1,
                                .accessLog = log_->get(),
                                .proxies = {*Networks::parse(networks), header}});
  }
  /// The clients that the log's `count` lines name, sorted. A line is written after its response
  /// was sent. So the lines of two connections may change places, or come later than the client's
  /// read.
  std::vector<std::string> clients(std::size_t count) const {
    std::vector<std::string> out;
    (void)test::eventually([&] {
      out.clear();
      std::ifstream in(path_);
      for (std::string line; std::getline(in, line) && !in.eof();)
        out.push_back(Json::parse(line)["client"].string());
      return out.size() >= count;
    });
    std::sort(out.begin(), out.end());
    return out;
  }

  test::ServedFolder folder_;
  test::TempFolder out_;
  std::filesystem::path path_ = out_.path() / "access.json";
  Result<std::unique_ptr<AccessLog>> log_ = AccessLog::open(path_.string());
};

TEST_F(Proxies, eachClientOfAProxyHasBoundsOfItsOwn) {
  const auto server = serve(ProxyHeader::kForwardedFor);
  test::RawClient one(server.port()), other(server.port());
  const auto ask = [](test::RawClient& proxy, const std::string& client) {
    return proxy.get("/livez", "X-Forwarded-For: " + client + "\r\n").status;
  };
  for (int i = 0; i < 2; ++i) {
    EXPECT_EQ(ask(one, "203.0.113.1"), 200u);
    EXPECT_EQ(ask(other, "6.6.6.6, 203.0.113.2"), 200u);
  }
  EXPECT_EQ(ask(other, "203.0.113.1"), 429u) << "by whatever connection of the proxy's";
  EXPECT_EQ(ask(one, "203.0.113.3"), 200u);
  EXPECT_EQ(one.get("/livez").status, 200u);
  const std::string none = "127.0.0.1", a = "203.0.113.1", b = "203.0.113.2", c = "203.0.113.3";
  EXPECT_EQ(clients(7), (std::vector<std::string>{none, a, a, a, b, b, c}))
      << "one request for which the proxy names nobody";
}

TEST_F(Proxies, whereTheProxyNamesNoAddressTheRequestIsItsOwn) {
  const auto server = serve(ProxyHeader::kForwardedFor);
  test::RawClient one(server.port()), other(server.port());
  const auto ask = [](test::RawClient& proxy, const std::string& lines) {
    return proxy.get("/livez", lines).status;
  };
  const std::string name = "X-Forwarded-For:";
  EXPECT_EQ(ask(one, name + " unknown\r\n"), 200u);
  EXPECT_EQ(ask(other, name + "\r\n"), 200u);
  EXPECT_EQ(ask(one, name + " 203.0.113.7\r\n" + name + " _hidden\r\n"), 429u)
      << "they share the limits of the proxy's address";
  EXPECT_EQ(ask(other, name + " 203.0.113.7\r\n"), 200u);
  EXPECT_EQ(ask(one, ""), 200u) << "a health check of the proxy's";
  const std::string none = "127.0.0.1";
  EXPECT_EQ(clients(5), (std::vector<std::string>{none, none, none, none, "203.0.113.7"}));
}

TEST_F(Proxies, othersAreNotBelieved) {
  const auto server = serve(ProxyHeader::kForwardedFor, "10.0.0.0/8");
  test::RawClient client(server.port());
  for (const unsigned status : {200u, 200u, 429u})
    EXPECT_EQ(client.get("/livez", "X-Forwarded-For: 203.0.113." + std::to_string(status) + "\r\n")
                  .status,
              status);
  EXPECT_EQ(clients(3), std::vector<std::string>(3, "127.0.0.1"));
}

TEST_F(Proxies, aStreamThroughAProxyIsItsClients) {
  const auto server = serve(ProxyHeader::kForwarded);
  const std::string handshake =
      "GET /v1/stream HTTP/1.1\r\nHost: a\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
      "Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n"
      "Sec-WebSocket-Protocol: qtet.v1\r\nForwarded: for=203.0.113.4\r\n\r\n";
  test::RawClient first(server.port()), second(server.port());
  ASSERT_TRUE(first.send(handshake));
  EXPECT_EQ(first.receive(true).status, 101u);
  ASSERT_TRUE(second.send(handshake));
  EXPECT_EQ(second.receive().status, 429u) << "the address has its one connection";
}

std::string proxyHead(std::string_view address) {
  std::string out("\r\n\r\n\0\r\nQUIT\n\x21\x11\0\x0C", 16);
  return out + std::string(address) + std::string("\x7F\0\0\1\x10\x20\0\x50", 8);
}

TEST_F(Proxies, theProxyProtocolTellsTheClientOfAConnection) {
  const auto server = serve(ProxyHeader::kProxyProtocol);
  const std::string request = "GET /livez HTTP/1.1\r\nHost: a\r\n\r\n";
  {
    test::RawClient client(server.port());
    const std::string head = proxyHead("\xCB\x01\x71\x05");
    ASSERT_TRUE(client.send(head.substr(0, 9)));
    std::this_thread::sleep_for(test::kQuiet);
    ASSERT_TRUE(client.send(head.substr(9) + request));
    EXPECT_EQ(client.receive().status, 200u);
    test::RawClient same(server.port());
    ASSERT_TRUE(same.send(head + request));
    EXPECT_TRUE(same.cutByServer()) << "the address has its one connection";
    test::RawClient other(server.port());
    ASSERT_TRUE(other.send(proxyHead("\xCB\x01\x71\x06") + request));
    EXPECT_EQ(other.receive().status, 200u);
  }
  test::RawClient bare(server.port());
  ASSERT_TRUE(bare.send(request));
  EXPECT_TRUE(bare.cutByServer()) << "a proxy that says nothing";
  EXPECT_EQ(clients(2), (std::vector<std::string>{"203.1.113.5", "203.1.113.6"}));
}

}  // namespace
}  // namespace qtet
