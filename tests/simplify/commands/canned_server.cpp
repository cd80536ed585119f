#include "tests/simplify/commands/canned_server.h"

#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <utility>

namespace qtet::test {

CannedServer::CannedServer(std::string answer, Manner manner)
    : socket_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)),
      answer_(std::move(answer)),
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

bool CannedServer::readHead(int client) {
  std::string head;
  std::array<char, 4096> piece;
  while (head.find("\r\n\r\n") == std::string::npos) {
    const ssize_t bytes = ::recv(client, piece.data(), piece.size(), 0);
    if (bytes <= 0) return false;
    head.append(piece.data(), static_cast<std::size_t>(bytes));
  }
  const std::scoped_lock lock(mutex_);
  requests_.push_back(head.substr(0, head.find("\r\n\r\n") + 4));
  return true;
}

void CannedServer::serve() {
  std::vector<int> held;
  for (int client = 0; (client = ::accept(socket_, nullptr, nullptr)) >= 0;) {
    held.push_back(client);
    if (manner_ == Manner::kMute || !readHead(client) || manner_ == Manner::kReadsOnly) continue;
    std::size_t sent = 0;
    while (sent < answer_.size()) {
      const ssize_t bytes =
          ::send(client, answer_.data() + sent, answer_.size() - sent, MSG_NOSIGNAL);
      if (bytes <= 0) break;
      sent += static_cast<std::size_t>(bytes);
    }
    ::shutdown(client, SHUT_WR);
  }
  for (const int client : held) ::close(client);
}

}  // namespace qtet::test
