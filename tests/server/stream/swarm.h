// Many WebSocket clients on one thread, each of which streams a whole log and compares every byte.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace qtet::test {

class Swarm {
 public:
  struct Client {
    int socket = -1;
    std::string buffer{};      ///< what came and is no whole frame yet
    std::size_t streamed = 0;  ///< bytes of the log that came, in its order
    bool upgraded = false;
    bool wrong = false;  ///< something came that is not the log
    bool done = false;   ///< the server said so
    bool ended = false;
    bool reads = true;
    unsigned closeCode = 0;

    [[nodiscard]] bool whole(const std::string& log) const {
      return !wrong && done && streamed == log.size();
    }
  };

  /// Connects `count` clients. Each opens `mesh`, a log of layout stream without fields, whose
  /// bytes are `log`, with credit for all of it. A receive buffer of few KB (`receiveBytes`) lets
  /// the server's side fill up.
  Swarm(std::uint16_t port, std::string mesh, const std::string& log, std::size_t count,
        int receiveBytes = 0);
  ~Swarm();
  Swarm(const Swarm&) = delete;
  Swarm& operator=(const Swarm&) = delete;

  /// Reads what comes until `enough` or the time has passed; the former?
  bool run(const std::function<bool(const Swarm&)>& enough, std::chrono::milliseconds time);
  [[nodiscard]] std::vector<Client>& clients() { return clients_; }
  [[nodiscard]] std::size_t count(const std::function<bool(const Client&)>& is) const;
  [[nodiscard]] std::size_t connected() const;

 private:
  void take(Client& client);
  void readFrames(Client& client);
  bool readFrame(Client& client);

  const std::string& log_;
  std::vector<Client> clients_;
};

}  // namespace qtet::test
