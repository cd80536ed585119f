// The listening server: accepts connections, spreads them over its threads, and ends in good order.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "server/decode/decoders.h"
#include "server/routes/viewer_files.h"
#include "server/session/services.h"
#include "server/store/level_maker.h"
#include "server/store/level_memory.h"
#include "server/store/store_limits.h"
#include "server/wire/access.h"
#include "server/wire/connection_limits.h"
#include "server/wire/tls_context.h"
#include "server/wire/trusted_proxies.h"

namespace qtet {

struct ServerOptions {
  std::string host = "127.0.0.1";
  std::uint16_t port = 8080;  ///< 0: any free one
  std::size_t threads = 1;    ///< for connections; at least 1
  std::size_t maxConnections = limits::kMaxConnections;
  std::size_t maxConnectionsPerAddress = limits::kMaxConnectionsPerAddress;  ///< 0: no bound
  /// For one address; 0: no bound.
  unsigned maxRequestsPerSecond = limits::kMaxRequestsPerSecond;
  std::chrono::nanoseconds maxOwedTime = limits::kMaxOwedTime;  ///< processor time of one address
  /// For one address, being made or waiting; 0: no bound.
  std::size_t maxLevelsPerAddress = limits::kMaxLevelJobsPerAddress;
  /// Memory that making one level may take, as memoryOf() predicts it.
  std::uint64_t maxLevelBytes = ownMemory() / limits::kLevelPartOfMemory;
  std::size_t maxHandshakes = limits::kMaxHandshakes;
  std::size_t maxHandshakesPerAddress = limits::kMaxHandshakesPerAddress;
  Timeouts timeouts{};
  std::optional<std::string> adminHost{};  ///< operators' paths are answered here and nowhere else
  std::uint16_t adminPort = 0;
  bool readyEarly = false;       ///< /readyz is 200 before the folder's names are known
  bool endOnSignals = false;     ///< SIGINT and SIGTERM do what stop() does
  KeptAnswers* cache = nullptr;  ///< finished levels; nullptr: none is kept
  AccessLog* accessLog = nullptr;
  /// For everything but the operators' address; nullptr: plain HTTP.
  CurrentTls* tls = nullptr;
  /// Who may read and change meshes; nullptr: everybody may read, nobody change.
  Access* access = nullptr;
  /// SIGHUP calls this if endOnSignals is set. Empty: SIGHUP ends the process, as usual.
  std::function<void()> reload{};
  /// SIGUSR1 calls this, likewise.
  std::function<void()> reopenLog{};
  /// Origins of pages that may open streams, ask for tickets and change meshes, as browsers write
  /// them; empty: any.
  std::vector<std::string> allowedOrigins{};
  /// Pages that may show the viewer in a frame, as CSP writes them.
  std::string frameAncestors = "*";
  /// Proxies whose clients count by their own addresses.
  TrustedProxies proxies{};
  /// Where levels are decoded; nullptr: `makeLevel` does it, in this process.
  Decoders* decoders = nullptr;
  LevelJobs::Maker makeLevel = makeLevelHere;
  UploadOptions uploads{};
  /// From the first signal to the end. Meanwhile the server serves everything, and /readyz is 503,
  /// so that a load balancer takes it out.
  std::chrono::milliseconds drain{0};
};

/// The thread that calls run() owns it, but for drain() and stop(). Store, viewer, cache, decoders,
/// access log, TLS and access must outlive it.
class Server {
 public:
  Server(const MeshStore& store, const ViewerFiles& viewer, ServerOptions options);
  ~Server();
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  /// Takes the port; clients may connect from then on. Errors: io (no such host, port in use or not
  /// allowed).
  [[nodiscard]] Status listen();
  /// The port taken. REQUIRES: listen() succeeded, and run() has not ended.
  [[nodiscard]] std::uint16_t port() const;
  /// That of the operators' address. REQUIRES: likewise, and that there is one.
  [[nodiscard]] std::uint16_t adminPort() const;
  /// "http://127.0.0.1:8080/", or https. REQUIRES: as port().
  [[nodiscard]] std::string url() const;

  /// Serves until stop() or a signal, then as long as responses under way need, at most the time of
  /// grace. REQUIRES: listen() succeeded.
  void run();
  /// As a signal does: not ready any more, and after the time of draining, or when asked again,
  /// stop(). Thread-safe; returns at once.
  void drain();
  /// Accepts nothing new, closes WebSockets with 1001, lets responses finish. Thread-safe; returns
  /// at once.
  void stop();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace qtet
