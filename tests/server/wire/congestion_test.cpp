// Tests how the kernel sends: without pacing to clients of this machine, and with the system's
// choice to others. Looks at the server's sockets, which are this process's.
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "tests/server/program/loopback.h"
#include "tests/server/program/served_folder.h"

namespace qtet {
namespace {

/// The server's ends of connections that were accepted at `port`.
std::vector<int> acceptedAt(std::uint16_t port) {
  std::vector<int> out;
  for (const auto& entry : std::filesystem::directory_iterator("/proc/self/fd")) {
    const int number = std::stoi(entry.path().filename());
    sockaddr_in local{};
    socklen_t size = sizeof(local);
    int listens = 1;
    socklen_t intSize = sizeof(listens);
    if (::getsockname(number, reinterpret_cast<sockaddr*>(&local), &size) != 0 ||
        local.sin_family != AF_INET || ntohs(local.sin_port) != port)
      continue;
    if (::getsockopt(number, SOL_SOCKET, SO_ACCEPTCONN, &listens, &intSize) == 0 && listens == 0)
      out.push_back(number);
  }
  return out;
}

std::string congestionControl(int socket) {
  std::array<char, 32> name{};
  socklen_t size = name.size() - 1;
  return ::getsockopt(socket, IPPROTO_TCP, TCP_CONGESTION, name.data(), &size) == 0 ? name.data()
                                                                                    : "(no socket)";
}

bool holdsBack(int socket) {
  int on = 1;
  socklen_t size = sizeof(on);
  return ::getsockopt(socket, IPPROTO_TCP, TCP_CORK, &on, &size) != 0 || on != 0;
}

std::string ofConnectionsTo(const std::string& host) {
  test::ServedFolder folder;
  test::RunningServer server(folder.store(), folder.viewer(), {.host = host});
  test::RawClient client(server.port());
  EXPECT_EQ(client.get("/livez").status, 200u);
  const std::vector<int> sockets = acceptedAt(server.port());
  return sockets.size() == 1 ? congestionControl(sockets.front()) : "(not one socket)";
}

TEST(Congestion, clientsOfThisMachineAreNotPaced) {
  EXPECT_EQ(ofConnectionsTo("127.0.0.1"), "reno");
}

TEST(Congestion, othersGetWhatTheSystemIsSetTo) {
  std::string ofTheSystem;
  std::ifstream("/proc/sys/net/ipv4/tcp_congestion_control") >> ofTheSystem;
  EXPECT_EQ(ofConnectionsTo("0.0.0.0"), ofTheSystem);
}

TEST(Congestion, nothingIsHeldBackBehindAStream) {
  test::ServedFolder folder;
  test::RunningServer server(folder.store(), folder.viewer());
  test::StreamClient client(server.port());
  ASSERT_TRUE(
      client.send(R"({"type":"open","mesh":"noise","fields":["density"],"credit":1000000000})"));
  std::size_t frames = 0;
  for (auto message = client.receive(); message; message = client.receive()) {
    frames += message->binary;
    if (!message->binary && message->text().find("done") != std::string::npos) break;
  }
  EXPECT_GT(frames, 2u);
  const std::vector<int> sockets = acceptedAt(server.port());
  ASSERT_EQ(sockets.size(), 1u);
  EXPECT_TRUE(test::eventually([&] { return !holdsBack(sockets.front()); }));
}

}  // namespace
}  // namespace qtet
