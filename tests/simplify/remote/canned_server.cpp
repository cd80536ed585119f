#include "tests/simplify/remote/canned_server.h"

#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <utility>

namespace qtet::test {

CannedServer::CannedServer(Answers answers, Manner manner)
    : socket_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)),
      answers_(std::move(answers)),
      manner_(manner) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof(address);
  ::bind(socket_, reinterpret_cast<const sockaddr*>(&address), size);
  ::listen(socket_, 8);
  ::getsockname(socket_, reinterpret_cast<sockaddr*>(&address), &size);
  port_ = ntohs(address.sin_port);
  thread_ = std::thread([this] { serve(); });
}

CannedServer::~CannedServer() {
  ::shutdown(socket_, SHUT_RDWR);  // wakes accept
  thread_.join();
  ::close(socket_);
}

std::string CannedServer::origin() const { return "http://127.0.0.1:" + std::to_string(port_); }

std::vector<std::string> CannedServer::requests() const {
  const std::scoped_lock lock(mutex_);
  return requests_;
}

std::string CannedServer::readHead(int client) {
  std::string head;
  std::array<char, 4096> piece;
  while (head.find("\r\n\r\n") == std::string::npos) {
    const ssize_t bytes = ::recv(client, piece.data(), piece.size(), 0);
    if (bytes <= 0) return {};
    head.append(piece.data(), static_cast<std::size_t>(bytes));
  }
  head.resize(head.find("\r\n\r\n") + 4);
  const std::scoped_lock lock(mutex_);
  requests_.push_back(head);
  return head;
}

void CannedServer::serve() {
  std::vector<int> held;
  for (int client = 0; (client = ::accept(socket_, nullptr, nullptr)) >= 0;) {
    held.push_back(client);
    const std::string head = manner_ == Manner::kMute ? "" : readHead(client);
    if (head.empty() || manner_ == Manner::kReadsOnly) continue;
    const std::string answer = answers_(head);
    std::size_t sent = 0;
    while (sent < answer.size()) {
      const ssize_t bytes =
          ::send(client, answer.data() + sent, answer.size() - sent, MSG_NOSIGNAL);
      if (bytes <= 0) break;
      sent += static_cast<std::size_t>(bytes);
    }
    ::shutdown(client, SHUT_WR);
  }
  for (const int client : held) ::close(client);
}

}  // namespace qtet::test
