#include "tests/server/stream/swarm.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>

#include "proto/messages.h"

namespace qtet::test {
namespace {

/// Masked with zeros, which RFC 6455 allows.
std::string masked(const std::string& text) {
  return std::string("\x81") + static_cast<char>(0x80 | text.size()) + std::string(4, '\0') + text;
}

std::string firstWords(const std::string& mesh) {
  return "GET /v1/stream HTTP/1.1\r\nHost: a\r\nUpgrade: websocket\r\nConnection: "
         "Upgrade\r\nSec-WebSocket-Version: 13\r\n"
         "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Protocol: qtet.v1\r\n\r\n" +
         masked(R"({"type":"open","credit":1000000000,"mesh":")" + mesh + "\"}");
}

int connected(std::uint16_t port, int receiveBytes) {
  const int out = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  if (receiveBytes > 0)
    ::setsockopt(out, SOL_SOCKET, SO_RCVBUF, &receiveBytes, sizeof(receiveBytes));
  if (::connect(out, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) == 0) return out;
  ::close(out);
  return -1;
}

}  // namespace

Swarm::Swarm(std::uint16_t port, std::string mesh, const std::string& log, std::size_t count,
             int receiveBytes)
    : log_(log) {
  const std::string words = firstWords(mesh);
  for (std::size_t i = 0; i < count; ++i) {
    Client client{.socket = test::connected(port, receiveBytes)};
    const bool said =
        client.socket >= 0 && ::send(client.socket, words.data(), words.size(), MSG_NOSIGNAL) ==
                                  static_cast<ssize_t>(words.size());
    client.ended = !said;
    clients_.push_back(std::move(client));
  }
}

Swarm::~Swarm() {
  for (const Client& client : clients_)
    if (client.socket >= 0) ::close(client.socket);
}

std::size_t Swarm::count(const std::function<bool(const Client&)>& is) const {
  return static_cast<std::size_t>(std::ranges::count_if(clients_, is));
}

std::size_t Swarm::connected() const {
  return count([](const Client& client) { return client.socket >= 0; });
}

bool Swarm::run(const std::function<bool(const Swarm&)>& enough, std::chrono::milliseconds time) {
  const auto deadline = std::chrono::steady_clock::now() + time;
  while (!enough(*this)) {
    if (std::chrono::steady_clock::now() >= deadline) return false;
    std::vector<pollfd> waiting;
    std::vector<Client*> whose;
    for (Client& client : clients_) {
      if (client.ended || !client.reads) continue;
      waiting.push_back({client.socket, POLLIN, 0});
      whose.push_back(&client);
    }
    ::poll(waiting.data(), waiting.size(), 20);
    for (std::size_t i = 0; i < waiting.size(); ++i)
      if (waiting[i].revents != 0) take(*whose[i]);
  }
  return true;
}

void Swarm::take(Client& client) {
  std::array<char, 65536> piece;
  const ssize_t count = ::recv(client.socket, piece.data(), piece.size(), MSG_DONTWAIT);
  if (count < 0 && (errno == EAGAIN || errno == EINTR)) return;
  if (count <= 0) {
    client.ended = true;
    return;
  }
  client.buffer.append(piece.data(), static_cast<std::size_t>(count));
  if (!client.upgraded) {
    const std::size_t end = client.buffer.find("\r\n\r\n");
    if (end == std::string::npos) return;
    client.upgraded = client.buffer.starts_with("HTTP/1.1 101");
    client.ended = !client.upgraded;
    client.buffer.erase(0, end + 4);
  }
  if (client.upgraded) readFrames(client);
}

void Swarm::readFrames(Client& client) {
  while (readFrame(client)) {
  }
}

bool Swarm::readFrame(Client& client) {
  const auto byte = [&](std::size_t i) { return static_cast<std::uint8_t>(client.buffer[i]); };
  if (client.buffer.size() < 2) return false;
  std::uint64_t bytes = byte(1);
  const std::size_t more = bytes == 126 ? 2 : bytes == 127 ? 8 : 0, head = 2 + more;
  if (client.buffer.size() < head) return false;
  if (more > 0) bytes = 0;
  for (std::size_t i = 2; i < head; ++i) bytes = bytes << 8 | byte(i);
  if (client.buffer.size() < head + bytes) return false;
  const std::string_view payload = std::string_view(client.buffer).substr(head, bytes);
  if (byte(0) == 0x82) {
    const std::size_t part =
        payload.size() - std::min<std::size_t>(payload.size(), FrameHeader::kBytes);
    const bool same =
        payload.size() >= FrameHeader::kBytes && client.streamed + part <= log_.size() &&
        std::memcmp(payload.data() + FrameHeader::kBytes, log_.data() + client.streamed, part) == 0;
    client.wrong |= !same;
    client.streamed += part;
  } else if (byte(0) == 0x88 && payload.size() >= 2) {
    client.closeCode = static_cast<unsigned>(byte(head) << 8 | byte(head + 1));
  } else if (byte(0) == 0x81) {
    client.done |= payload.find("\"done\"") != std::string_view::npos;
    client.wrong |= payload.find("\"error\"") != std::string_view::npos;
  } else if (byte(0) == 0x89) {
    const std::string pong("\x8A\x80\0\0\0\0", 6);
    (void)::send(client.socket, pong.data(), pong.size(), MSG_NOSIGNAL);
  } else {
    client.wrong = true;
  }
  client.buffer.erase(0, head + bytes);
  return true;
}

}  // namespace qtet::test
