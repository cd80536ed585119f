// A server on a free port of this machine that answers every request with the same bytes, right or
// wrong ones.
#pragma once

#include <cstdint>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace qtet::test {

class CannedServer {
 public:
  /// How a request is treated: with an answer, or not at all, its connection being held open.
  enum class Manner : std::uint8_t { kAnswers, kReadsOnly, kMute };

  explicit CannedServer(std::string answer, Manner manner = Manner::kAnswers);
  ~CannedServer();
  CannedServer(const CannedServer&) = delete;
  CannedServer& operator=(const CannedServer&) = delete;

  /// "http://127.0.0.1:PORT".
  [[nodiscard]] std::string origin() const;
  /// The requests that came, their bodies left out.
  [[nodiscard]] std::vector<std::string> requests() const;

 private:
  void serve();
  /// Reads a request's head; whether one came.
  [[nodiscard]] bool readHead(int client);

  int socket_;
  std::uint16_t port_ = 0;
  std::string answer_;
  Manner manner_;
  mutable std::mutex mutex_;
  std::vector<std::string> requests_;
  std::thread thread_;
};

}  // namespace qtet::test
