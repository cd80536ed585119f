// The listening server: accepts connections, spreads them over its threads, and ends in good order.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

#include "server/level_jobs.h"
#include "server/limits.h"
#include "server/mesh_store.h"
#include "server/viewer_files.h"

namespace qtet {

struct ServerOptions {
  std::string host = "127.0.0.1";
  std::uint16_t port = 8080;  ///< 0: any free one
  std::size_t threads = 1;    ///< for connections; at least 1
  std::size_t maxConnections = limits::kMaxConnections;
  bool endOnSignals = false;  ///< SIGINT and SIGTERM do what stop() does
  LevelJobs::Maker makeLevel = qtet::makeLevel;
};

/// Store and viewer must outlive it.
class Server {
 public:
  Server(const MeshStore& store, const ViewerFiles& viewer, ServerOptions options);
  ~Server();
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  /// Takes the port; clients may connect from then on. Errors: io (no such host, port in use or not allowed).
  [[nodiscard]] Status listen();
  /// The port taken. REQUIRES: listen() succeeded.
  [[nodiscard]] std::uint16_t port() const;
  /// "http://127.0.0.1:8080/". REQUIRES: listen() succeeded.
  [[nodiscard]] std::string url() const;

  /// Serves until stop() or a signal, then as long as responses under way need, at most limits::kGraceTime. REQUIRES: listen() succeeded.
  void run();
  /// Accepts nothing new, closes WebSockets with 1001, lets responses finish. Thread-safe; returns at once.
  void stop();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace qtet
