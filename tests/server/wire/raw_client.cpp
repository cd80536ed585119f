#include <arpa/inet.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <stdexcept>

#include "tests/server/program/loopback.h"

namespace qtet::test {

RunningServer::RunningServer(const MeshStore& store, const ViewerFiles& viewer,
                             ServerOptions options)
    : server_(store, viewer, [&] {
        options.port = 0;
        return std::move(options);
      }()) {
  if (const Status listening = server_.listen(); !listening)
    throw std::runtime_error(listening.error().message);
  thread_ = std::thread([this] { server_.run(); });
}

RunningServer::~RunningServer() {
  stop();
  join();
}

void RunningServer::join() {
  if (thread_.joinable()) thread_.join();
}

bool RunningServer::comesTo(std::string_view figure, std::size_t value) const {
  const std::string line = "\nqtet_" + std::string(figure) + " " + std::to_string(value) + "\n";
  return eventually(
      [&] { return RawClient(port()).get("/metrics").body.find(line) != std::string::npos; });
}

std::string HttpResponse::header(const std::string& name) const {
  const auto it = headers.find(name);
  return it == headers.end() ? "" : it->second;
}

HttpResponse readResponse(std::string& buffer, const std::function<bool()>& fill, bool head) {
  HttpResponse out;
  std::size_t end = 0;
  while ((end = buffer.find("\r\n\r\n")) == std::string::npos)
    if (!fill()) return {};
  const auto status = static_cast<unsigned>(std::stoul(buffer.substr(9, 3)));
  for (std::size_t line = buffer.find("\r\n") + 2; line < end;) {
    const std::size_t next = buffer.find("\r\n", line);
    const std::size_t colon = buffer.find(": ", line);
    std::string name = buffer.substr(line, colon - line);
    std::ranges::transform(name, name.begin(),
                           [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    out.headers.emplace(name, buffer.substr(colon + 2, next - colon - 2));
    line = next + 2;
  }
  buffer.erase(0, end + 4);
  const std::string length = out.header("content-length");
  const std::size_t bytes = head || length.empty() ? 0 : std::stoull(length);
  while (buffer.size() < bytes)
    if (!fill()) return {};
  out.body = buffer.substr(0, bytes);
  buffer.erase(0, bytes);
  out.status = status;
  return out;
}

RawClient::RawClient(std::uint16_t port, const char* from)
    : socket_(::socket(AF_INET, SOCK_STREAM, 0)) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  ::inet_pton(AF_INET, from, &address.sin_addr);
  if (::bind(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) != 0)
    throw std::runtime_error("this is no address of this machine");
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  const int on = 1;
  ::setsockopt(socket_, IPPROTO_TCP, TCP_NODELAY, &on, sizeof(on));
  const timeval patience{std::chrono::seconds(kPatience).count(), 0};
  ::setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof(patience));
  if (::connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) != 0)
    throw std::runtime_error(std::string("no connection to the server: ") + std::strerror(errno));
}

RawClient::~RawClient() { ::close(socket_); }

bool RawClient::send(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t n = ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (n <= 0) return false;
    bytes.remove_prefix(static_cast<std::size_t>(n));
  }
  return true;
}

bool RawClient::fill() {
  std::array<char, 65536> piece;
  ssize_t n = 0;
  do {
    errno = 0;
    n = ::recv(socket_, piece.data(), piece.size(), 0);
  } while (
      n < 0 &&
      errno ==
          EINTR);  // a process that was stopped and goes on hears of it, where there is a time-out
  if (n > 0) buffer_.append(piece.data(), static_cast<std::size_t>(n));
  return n > 0;
}

HttpResponse RawClient::receive(bool head) {
  return readResponse(buffer_, [this] { return fill(); }, head);
}

HttpResponse RawClient::get(std::string_view target, std::string_view headers) {
  send("GET " + std::string(target) + " HTTP/1.1\r\nHost: localhost\r\n" + std::string(headers) +
       "\r\n");
  return receive();
}

std::string RawClient::readToEnd() {
  while (fill()) {
  }
  return std::exchange(buffer_, {});
}

bool RawClient::closedByServer() { return buffer_.empty() && !fill() && errno == 0; }

bool RawClient::cutByServer() {
  return closedByServer() || (buffer_.empty() && errno == ECONNRESET);
}

bool RawClient::answerBegins() { return !buffer_.empty() || fill(); }

bool RawClient::hasAnswer() const {
  char byte = 0;
  return !buffer_.empty() || ::recv(socket_, &byte, 1, MSG_PEEK | MSG_DONTWAIT) >= 0;
}

bool RawClient::wasReset() const {
  int trouble = 0;
  socklen_t bytes = sizeof(trouble);
  return ::getsockopt(socket_, SOL_SOCKET, SO_ERROR, &trouble, &bytes) == 0 && trouble != 0;
}

void RawClient::finishSending() { ::shutdown(socket_, SHUT_WR); }

}  // namespace qtet::test
