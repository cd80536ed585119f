// The services that every connection needs. The objects outlive all connections.
#pragma once

#include <chrono>
#include <functional>
#include <string>
#include <vector>

#include "server/http/uploads.h"
#include "server/routes/answer.h"
#include "server/store/level_jobs.h"
#include "server/store/mesh_store.h"
#include "server/stream/stream_limits.h"
#include "server/wire/access.h"
#include "server/wire/access_log.h"
#include "server/wire/connection_limits.h"
#include "server/wire/http_limits.h"
#include "server/wire/metrics.h"

// Only declared, like the three classes below: the tests of a running server compile without Asio.
namespace boost::asio {
// NOLINTNEXTLINE(readability-identifier-naming): Asio's
class thread_pool;
}  // namespace boost::asio

namespace qtet {

namespace limits {
/// From SIGTERM to the end: what responses under way, and closing handshakes, have left. Below the
/// 10 s of common supervisors.
inline constexpr std::chrono::seconds kGraceTime{8};
}  // namespace limits

class AddressLimits;
class Handshakes;
struct TrustedProxies;

/// How long a client may take.
struct Timeouts {
  /// For a request, or for a handshake with its wait for a place.
  std::chrono::milliseconds header = limits::kHeaderTime;
  std::chrono::milliseconds handshake = limits::kHandshakePatience;
  std::chrono::milliseconds idle = limits::kIdleTime;
  std::chrono::milliseconds write = limits::kWriteTime;
  std::chrono::milliseconds body = limits::kBodyTime;
  std::chrono::milliseconds silence = limits::kSilenceTime;  ///< of a WebSocket
  std::chrono::milliseconds grace = limits::kGraceTime;      ///< of all, once the server ends
};

struct Services {
  const MeshStore& store;
  std::function<Answer(const RequestView&)> route;
  bool streams = true;  ///< WebSockets are answered
  LevelJobs& jobs;
  LevelJobs& pointJobs;
  /// Memory that making one level may take, as memoryOf() predicts it.
  std::uint64_t maxLevelBytes;
  Metrics& metrics;
  AccessLog* accessLog = nullptr;
  Timeouts timeouts{};
  Uploads* uploads = nullptr;  ///< where the router knows of uploads
  /// Where uploads are begun and written, and meshes removed.
  boost::asio::thread_pool* writers = nullptr;
  /// Where uploads are checked and published, one after the other.
  boost::asio::thread_pool* checkers = nullptr;
  /// Where long texts are made and compressed.
  boost::asio::thread_pool* describers = nullptr;
  /// Who may read what; nullptr: everybody everything.
  Access* access = nullptr;
  /// Origins of pages that may open streams; nullptr or empty: any.
  const std::vector<std::string>* allowedOrigins = nullptr;
  Handshakes* handshakes = nullptr;  ///< where there is TLS
  /// All clients are on this machine, and data for them waits for no timer.
  bool unpaced = false;
  /// Counts the clients of trusted proxies.
  AddressLimits* addresses = nullptr;
  const TrustedProxies* proxies = nullptr;  ///< nullptr: there are none
};

}  // namespace qtet
