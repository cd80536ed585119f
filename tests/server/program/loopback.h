// A real server on a free port of this machine, and clients that send exactly the given bytes.
#pragma once

#include <chrono>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <thread>

#include "proto/bytes.h"
#include "proto/messages.h"
#include "server/program/server.h"

namespace qtet::test {

/// How long a test waits for an event that must happen, and for one that must not. Only a failing
/// test waits for the first, even on a slow machine. It is below limits::kFolderInterval, since
/// then every folder is read anyway.
inline constexpr auto kPatience = std::chrono::seconds(50);
inline constexpr auto kQuiet = std::chrono::milliseconds(150);
/// A server's time-out that a test waits for. A machine may stall for longer than this, so nothing
/// that has to be in time may be under it.
inline constexpr auto kShort = std::chrono::milliseconds(300);
/// A server's time-out that no test lives to see, where it must be something else that ends the
/// wait.
inline constexpr auto kNever = std::chrono::hours(1);

/// Waits until `condition` holds; false: it did not within kPatience.
template <class Condition>
bool eventually(Condition condition) {
  const auto deadline = std::chrono::steady_clock::now() + kPatience;
  while (!condition()) {
    if (std::chrono::steady_clock::now() > deadline) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return true;
}

/// Runs a server in a thread until the object goes.
class RunningServer {
 public:
  RunningServer(const MeshStore& store, const ViewerFiles& viewer, ServerOptions options = {});
  ~RunningServer();

  [[nodiscard]] std::uint16_t port() const { return server_.port(); }
  [[nodiscard]] std::uint16_t adminPort() const { return server_.adminPort(); }
  void stop() { server_.stop(); }
  void drain() { server_.drain(); }
  /// Waits for run() to return.
  void join();
  /// Whether the figure of /metrics, named without "qtet_", comes to `value` within kPatience.
  [[nodiscard]] bool comesTo(std::string_view figure, std::size_t value) const;

 private:
  Server server_;
  std::thread thread_;
};

struct HttpResponse {
  unsigned status = 0;                              ///< 0: none, or not a whole one
  std::multimap<std::string, std::string> headers;  ///< names in lower case
  std::string body;

  [[nodiscard]] std::string header(const std::string& name) const;
};

/// Takes one response out of `buffer`, which `fill` appends to (false: nothing more comes); `head`:
/// it answers a HEAD and has no body.
HttpResponse readResponse(std::string& buffer, const std::function<bool()>& fill,
                          bool head = false);

/// A TCP connection with a time-out of kPatience on every read.
class RawClient {
 public:
  /// `from`: one of the machine's own addresses, 127.0.0.0/8.
  explicit RawClient(std::uint16_t port, const char* from = "127.0.0.1");
  ~RawClient();
  RawClient(const RawClient&) = delete;
  RawClient& operator=(const RawClient&) = delete;

  bool send(std::string_view bytes);
  /// Reads one response; `head` = it answers a HEAD and has no body.
  HttpResponse receive(bool head = false);
  /// Sends a GET and reads its response; `headers` are whole lines.
  HttpResponse get(std::string_view target, std::string_view headers = "");
  /// Everything up to the server's closing.
  std::string readToEnd();
  /// Whether the server closes within kPatience (having sent nothing more).
  bool closedByServer();
  /// The same, or that it cuts the connection, which a client with bytes of its own on the way
  /// sees.
  bool cutByServer();
  /// Waits for the first byte of an answer, and leaves it to be read; false: none came.
  bool answerBegins();
  /// Whether something has come already, the end included.
  [[nodiscard]] bool hasAnswer() const;
  /// Whether the server has reset the connection, so that bytes on their way to us may be lost.
  [[nodiscard]] bool wasReset() const;
  /// Ends the client's half.
  void finishSending();

 private:
  bool fill();

  int socket_;
  std::string buffer_;
};

/// A WebSocket client.
class StreamClient {
 public:
  struct Message {
    bool binary = false;
    Bytes bytes;
    [[nodiscard]] std::string text() const { return {bytes.begin(), bytes.end()}; }
  };

  /// Connects and shakes hands; `httpStatus` reports a refusal.
  explicit StreamClient(std::uint16_t port, const std::string& subprotocol = "qtet.v1",
                        const std::string& path = "/v1/stream");
  ~StreamClient();

  [[nodiscard]] bool connected() const;
  [[nodiscard]] unsigned httpStatus() const;
  [[nodiscard]] std::string acceptedSubprotocol() const;
  bool send(const std::string& text);
  bool sendBinary(const std::string& bytes);
  /// nullopt: nothing came in time, or the socket has ended.
  std::optional<Message> receive(std::chrono::milliseconds patience = kPatience);
  /// The next message as one of the server's words.
  std::optional<ServerMessage> receiveWord();
  /// Waits for the end; the close code, or 0 where none came.
  unsigned closeCode();
  /// Says good-bye.
  void close();
  /// Goes without one.
  void vanish();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace qtet::test
