// A simulated client, and what it may ask the world.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "codec/log/log_index.h"
#include "tests/server/simulator/kernel.h"

namespace qtet::simulator {

/// A log that is served.
struct ServedLog {
  std::string name, digest;
  std::string bytes;  ///< the whole file
  LogIndex index;
  std::vector<std::string> fields;
};

/// All that clients share.
struct World {
  Kernel& kernel;
  Random& random;
  std::vector<ServedLog> logs;
  /// Status and hash of a body that never changes, by request.
  std::map<std::string, std::pair<unsigned, std::size_t>> bodies{};
  /// Connections of sound clients may break, too.
  bool breaks = false;
  bool ending = false;
  /// How much was seen: "answers", "blocks", "cut" and so on.
  std::map<std::string, std::uint64_t> seen{};
};

class Client : public ClientEnd {
 public:
  Client(World& world, std::string kind, LineKind line, std::uint32_t address)
      : world_(world), kind_(std::move(kind)), line_(line), address_(address) {}
  ~Client() override {
    *alive_ = false;
    if (socket_ && socket_->client == this) socket_->client = nullptr;
  }

  /// Connects, and begins once the server's answer to that is there.
  [[nodiscard]] SocketPointer connect() {
    socket_ = world_.kernel.connect(line_, address_, *this);
    later(2 * line_.latency, [this] { begin(); });
    return socket_;
  }
  void ended(bool lost) override {
    over_ = true;
    whenOver(lost);
  }

  [[nodiscard]] bool over() const { return over_; }
  /// The server has not let go of the connection.
  [[nodiscard]] bool holds() const { return !over_ && !socket_->closed; }
  [[nodiscard]] const std::string& kind() const { return kind_; }
  [[nodiscard]] const LineKind& line() const { return line_; }
  /// By then something has to have happened, and that is what.
  struct Due {
    Time when;
    std::string what;
  };
  [[nodiscard]] const std::optional<Due>& due() const { return due_; }
  /// Gives the connection up.
  void leave() {
    if (over_) return;
    over_ = true;
    due_.reset();
    world_.kernel.reset(socket_);
  }
  [[noreturn]] void wrong(const std::string& what) const {
    throw Violation{kind_ + ": " + what + (socket_ ? " (" + socket_->text() + ")" : "")};
  }

 protected:
  virtual void begin() = 0;
  virtual void whenOver(bool /*lost*/) {}
  void say(std::string_view bytes) {
    if (!over_) world_.kernel.send(socket_, bytes);
  }
  void finish() {
    if (!over_) world_.kernel.finish(socket_);
  }
  /// Unless the client has gone by then.
  void later(Time time, std::function<void()> what) {
    world_.kernel.after(time, [this, alive = alive_, what = std::move(what)] {
      if (*alive && !over_) what();
    });
  }
  void expect(Time within, std::string what) {
    within_ = within;
    due_ = {world_.kernel.now() + within, std::move(what)};
  }
  /// The time begins again.
  void expectStill() {
    if (due_) due_->when = world_.kernel.now() + within_;
  }
  void expectNothing() { due_.reset(); }
  [[nodiscard]] Random& random() { return world_.random; }

  World& world_;
  SocketPointer socket_;

 private:
  const std::string kind_;
  const LineKind line_;
  const std::uint32_t address_;
  std::optional<Due> due_;
  Time within_{};
  bool over_ = false;
  std::shared_ptr<bool> alive_ = std::make_shared<bool>(true);
};

/// Sound clients: whatever they get has to be right, and in time.
[[nodiscard]] std::unique_ptr<Client> honestReader(World& world, LineKind line,
                                                   std::uint32_t address);
[[nodiscard]] std::unique_ptr<Client> honestViewer(World& world, LineKind line,
                                                   std::uint32_t address);
/// One of those that stall, break rules or ask for too much; most of them have to be ended.
[[nodiscard]] std::unique_ptr<Client> hostileClient(World& world, LineKind line,
                                                    std::uint32_t address);

inline constexpr std::string_view kHostile = "hostile";

/// A client's WebSocket frame, masked.
[[nodiscard]] std::string frameOf(unsigned opcode, std::string_view payload, bool isLast = true);
/// The handshake for `/v1/stream`.
[[nodiscard]] std::string streamHandshake();

}  // namespace qtet::simulator
