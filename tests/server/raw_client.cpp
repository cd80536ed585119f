#include <arpa/inet.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <stdexcept>

#include "tests/server/loopback.h"

namespace qtet::test {

RunningServer::RunningServer(const MeshStore& store, const ViewerFiles& viewer, ServerOptions options)
    : server_(store, viewer, [&] {
        options.port = 0;
        return std::move(options);
      }()) {
  if (const Status listening = server_.listen(); !listening) throw std::runtime_error(listening.error().message);
  thread_ = std::thread([this] { server_.run(); });
}

RunningServer::~RunningServer() {
  stop();
  join();
}

void RunningServer::join() {
  if (thread_.joinable()) thread_.join();
}

std::string HttpResponse::header(const std::string& name) const {
  const auto it = headers.find(name);
  return it == headers.end() ? "" : it->second;
}

RawClient::RawClient(std::uint16_t port) : socket_(::socket(AF_INET, SOCK_STREAM, 0)) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  const int on = 1;
  ::setsockopt(socket_, IPPROTO_TCP, TCP_NODELAY, &on, sizeof(on));
  const timeval patience{std::chrono::seconds(kPatience).count(), 0};
  ::setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof(patience));
  if (::connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) != 0)
    throw std::runtime_error("the server does not answer");
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
  const ssize_t n = ::recv(socket_, piece.data(), piece.size(), 0);
  if (n > 0) buffer_.append(piece.data(), static_cast<std::size_t>(n));
  return n > 0;
}

HttpResponse RawClient::receive(bool head) {
  HttpResponse out;
  std::size_t end = 0;
  while ((end = buffer_.find("\r\n\r\n")) == std::string::npos)
    if (!fill()) return {};
  const auto status = static_cast<unsigned>(std::stoul(buffer_.substr(9, 3)));
  for (std::size_t line = buffer_.find("\r\n") + 2; line < end;) {
    const std::size_t next = buffer_.find("\r\n", line);
    const std::size_t colon = buffer_.find(": ", line);
    std::string name = buffer_.substr(line, colon - line);
    std::ranges::transform(name, name.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    out.headers.emplace(name, buffer_.substr(colon + 2, next - colon - 2));
    line = next + 2;
  }
  buffer_.erase(0, end + 4);
  const std::string length = out.header("content-length");
  const std::size_t bytes = head || length.empty() ? 0 : std::stoull(length);
  while (buffer_.size() < bytes)
    if (!fill()) return {};
  out.body = buffer_.substr(0, bytes);
  buffer_.erase(0, bytes);
  out.status = status;
  return out;
}

HttpResponse RawClient::get(std::string_view target, std::string_view headers) {
  send("GET " + std::string(target) + " HTTP/1.1\r\nHost: localhost\r\n" + std::string(headers) + "\r\n");
  return receive();
}

std::string RawClient::readToEnd() {
  while (fill()) {
  }
  return std::exchange(buffer_, {});
}

bool RawClient::closedByServer() {
  if (!buffer_.empty()) return false;
  char byte = 0;
  return ::recv(socket_, &byte, 1, 0) == 0;
}

void RawClient::finishSending() { ::shutdown(socket_, SHUT_WR); }

}  // namespace qtet::test
