#include "simplify/commands/http_client.h"

#include <netdb.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <cstring>
#include <memory>
#include <optional>

namespace qtet {
namespace {

using namespace std::chrono_literals;

/// Of an answer: a mesh's description with thousands of levels takes some 100 KB.
constexpr std::size_t kMaxAnswerBytes = 4u << 20;
/// For connecting, and for each piece sent or read. The last one is long: the server decodes the
/// log before it answers, and others before it; a server that is gone for good is noticed sooner,
/// by asking its system now and then.
constexpr auto kStepTime = 30s;
constexpr auto kAnswerTime = 3600s;
constexpr int kKeepAliveSeconds = 30;
/// How often whoever waits for the answer is told that there is none yet.
constexpr auto kWaitingTime = 1s;
constexpr std::size_t kPiece = 256u << 10;

class Socket {
 public:
  explicit Socket(int file) : file_(file) {}
  ~Socket() {
    if (file_ >= 0) ::close(file_);
  }
  Socket(Socket&& other) noexcept : file_(std::exchange(other.file_, -1)) {}
  Socket& operator=(Socket&&) = delete;
  [[nodiscard]] int get() const { return file_; }
  /// The events that came; 0: none in time.
  [[nodiscard]] short wait(short events, std::chrono::milliseconds time) const {
    pollfd file{file_, events, 0};
    const int n = ::poll(&file, 1, static_cast<int>(time.count()));
    return n > 0 ? file.revents : short{0};
  }

 private:
  int file_;
};

std::unexpected<Error> lost(const std::string& what) { return fail(ErrorCode::kIo, what); }
std::unexpected<Error> lost(const std::string& what, int number) {
  return lost(what + ": " + std::strerror(number));
}

Result<Socket> connectTo(const addrinfo& address, const std::string& name) {
  Socket socket(::socket(address.ai_family, address.ai_socktype | SOCK_CLOEXEC | SOCK_NONBLOCK,
                         address.ai_protocol));
  if (socket.get() < 0) return lost("no socket", errno);
  int trouble = ::connect(socket.get(), address.ai_addr, address.ai_addrlen) == 0 ? 0 : errno;
  if (trouble == EINPROGRESS) {
    socklen_t size = sizeof(trouble);
    if (socket.wait(POLLOUT, kStepTime) == 0) return lost(name + " does not answer");
    ::getsockopt(socket.get(), SOL_SOCKET, SO_ERROR, &trouble, &size);
  }
  if (trouble != 0) return lost(name, trouble);
  const int on = 1;
  ::setsockopt(socket.get(), SOL_SOCKET, SO_KEEPALIVE, &on, sizeof(on));
  for (const int option : {TCP_KEEPIDLE, TCP_KEEPINTVL})
    ::setsockopt(socket.get(), IPPROTO_TCP, option, &kKeepAliveSeconds, sizeof(kKeepAliveSeconds));
  return socket;
}

Result<Socket> connectTo(const HttpUrl& server) {
  addrinfo hints{};
  hints.ai_socktype = SOCK_STREAM;
  addrinfo* found = nullptr;
  if (const int number = ::getaddrinfo(server.host.c_str(), server.port.c_str(), &hints, &found);
      number != 0)
    return lost(server.host + ": " + ::gai_strerror(number));
  const std::unique_ptr<addrinfo, decltype(&::freeaddrinfo)> owner(found, ::freeaddrinfo);
  Result<Socket> out = lost(server.authority() + " has no address");
  for (const addrinfo* at = found; at != nullptr; at = at->ai_next) {
    Result<Socket> socket = connectTo(*at, server.authority());
    if (socket) return socket;
    out = std::unexpected(socket.error());
  }
  return out;
}

/// Errors: io. true: all was sent; false: the server has answered already.
Result<bool> sendAll(const Socket& socket, ByteView bytes,
                     const std::function<void(std::uint64_t)>& progress) {
  for (std::size_t sent = 0; sent < bytes.size();) {
    const short events = socket.wait(POLLIN | POLLOUT, kStepTime);
    if (events == 0) return lost("the server takes nothing any more");
    if ((events & POLLIN) != 0) return false;
    const ssize_t n = ::send(socket.get(), bytes.data() + sent,
                             std::min(bytes.size() - sent, kPiece), MSG_NOSIGNAL);
    if (n < 0 && errno != EAGAIN && errno != EINTR) return lost("the connection was lost", errno);
    if (n > 0) sent += static_cast<std::size_t>(n);
    if (progress) progress(sent);
  }
  return true;
}

/// Reads until the server closes: every request asks it to.
Result<std::string> readAll(const Socket& socket, const std::function<void()>& waiting) {
  std::string out;
  std::array<char, 16384> piece;
  const auto end = std::chrono::steady_clock::now() + kAnswerTime;
  for (;;) {
    while (socket.wait(POLLIN, kWaitingTime) == 0) {
      if (std::chrono::steady_clock::now() >= end) return lost("the server does not answer");
      if (waiting) waiting();
    }
    const ssize_t n = ::recv(socket.get(), piece.data(), piece.size(), 0);
    if (n == 0) return out;
    if (n < 0 && errno != EAGAIN && errno != EINTR)
      return out.empty() ? Result<std::string>(lost("the connection was lost", errno)) : out;
    if (n > 0) out.append(piece.data(), static_cast<std::size_t>(n));
    if (out.size() > kMaxAnswerBytes) return lost("the server's answer does not end");
  }
}

Result<HttpAnswer> parseAnswer(const std::string& text) {
  const std::size_t end = text.find("\r\n\r\n");
  HttpAnswer out;
  const bool http = text.starts_with("HTTP/1.") && text.size() > 12 && end != std::string::npos;
  if (http) std::from_chars(text.data() + 9, text.data() + 12, out.status);
  if (text.empty()) return lost("the server closed without an answer");
  if (out.status < 100) return fail(ErrorCode::kBadValue, "what answers there does not speak HTTP");
  out.body = text.substr(end + 4);
  return out;
}

}  // namespace

std::string HttpUrl::authority() const {
  return (host.find(':') != std::string::npos ? "[" + host + "]" : host) + ":" + port;
}

Result<HttpUrl> parseHttpUrl(const std::string& text) {
  constexpr std::string_view kScheme = "http://";
  const auto wrong = [&](const std::string& why) {
    return fail(ErrorCode::kBadValue, "'" + text + "' " + why);
  };
  if (text.starts_with("https://"))
    return wrong(
        "is https, which this tool does not speak; give the server's own http address, perhaps "
        "through an ssh tunnel");
  if (!text.starts_with(kScheme))
    return wrong("is no address like http://host:8080/v1/meshes/name");
  const std::size_t slash = std::min(text.find('/', kScheme.size()), text.size());
  std::string authority = text.substr(kScheme.size(), slash - kScheme.size());
  HttpUrl out;
  out.path = slash == text.size() ? "/" : text.substr(slash);
  const std::size_t colon = authority.rfind(':');
  if (colon != std::string::npos && authority.find(']', colon) == std::string::npos) {
    out.port = authority.substr(colon + 1);
    authority.resize(colon);
  }
  if (authority.starts_with('[') && authority.ends_with(']'))
    authority = authority.substr(1, authority.size() - 2);
  out.host = authority;
  const bool badPort = out.port.empty() || out.port.size() > 5 ||
                       out.port.find_first_not_of("0123456789") != std::string::npos;
  const bool badPath = std::ranges::any_of(
      out.path, [](char c) { return c <= ' ' || c >= 0x7F || c == '?' || c == '#'; });
  if (out.host.empty() || out.host.find_first_of(" @\r\n") != std::string::npos || badPort ||
      badPath)
    return wrong("is no address like http://host:8080/v1/meshes/name");
  return out;
}

std::string encodedSegment(const std::string& text) {
  constexpr std::string_view kDigits = "0123456789ABCDEF";
  std::string out;
  for (const char c : text) {
    const bool plain = (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') ||
                       c == '-' || c == '.' || c == '_' || c == '~';
    const auto byte = static_cast<std::uint8_t>(c);
    out += plain ? std::string(1, c) : std::string{'%', kDigits[byte >> 4], kDigits[byte & 15]};
  }
  return out;
}

Result<HttpAnswer> exchange(const HttpUrl& server, const HttpRequest& request) {
  Result<Socket> socket = connectTo(server);
  if (!socket) return std::unexpected(socket.error());
  const std::string head =
      request.method + " " + request.target + " HTTP/1.1\r\nHost: " + server.authority() +
      "\r\nUser-Agent: qtet/" QTET_VERSION "\r\nConnection: close\r\nContent-Length: " +
      std::to_string(request.body.size()) + "\r\n" + request.headers + "\r\n";
  Result<bool> sent =
      sendAll(*socket, {reinterpret_cast<const std::uint8_t*>(head.data()), head.size()}, {});
  if (sent && *sent) sent = sendAll(*socket, request.body, request.progress);
  if (!sent) return std::unexpected(sent.error());
  const Result<std::string> answer = readAll(*socket, request.waiting);
  if (!answer) return std::unexpected(answer.error());
  return parseAnswer(*answer);
}

}  // namespace qtet
