// A server on a free port of this machine whose answers a test chooses, right or wrong ones.
#pragma once

#include <cstdint>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace qtet::test {

class CannedServer {
 public:
  /// How a request is treated: with an answer, or not at all, its connection being held open.
  enum class Manner : std::uint8_t { kAnswers, kReadsOnly, kMute };

  /// The whole answer to a request's head, both as they travel.
  using Answers = std::function<std::string(const std::string& head)>;

  explicit CannedServer(Answers answers, Manner manner = Manner::kAnswers);
  /// The same answer to every request.
  explicit CannedServer(const std::string& answer, Manner manner = Manner::kAnswers)
      : CannedServer([answer](const std::string&) { return answer; }, manner) {}
  ~CannedServer();
  CannedServer(const CannedServer&) = delete;
  CannedServer& operator=(const CannedServer&) = delete;

  /// "http://127.0.0.1:PORT".
  [[nodiscard]] std::string origin() const;
  /// The requests that came, their bodies left out.
  [[nodiscard]] std::vector<std::string> requests() const;

 private:
  void serve();
  /// Reads a request's head; "" where none came.
  [[nodiscard]] std::string readHead(int client);

  int socket_;
  std::uint16_t port_ = 0;
  Answers answers_;
  Manner manner_;
  mutable std::mutex mutex_;
  std::vector<std::string> requests_;
  std::thread thread_;
};

}  // namespace qtet::test
