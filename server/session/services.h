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

namespace qtet {

namespace limits {
/// From SIGTERM to the end: what responses under way, and closing handshakes, have left. Below the
/// 10 s of common supervisors.
inline constexpr std::chrono::seconds kGraceTime{8};
}  // namespace limits

// Only declared: the tests of a running server compile without Asio.
class AddressLimits;
class Handshakes;
struct TrustedProxies;

/// Has work done soon, on a thread that may wait for the disk.
using Workers = std::function<void(std::move_only_function<void()>)>;

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

/// Immutable once the server listens; what it refers to guards itself.
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
  Workers writers{};
  /// Where uploads are checked and published, one after the other.
  Workers checkers{};
  /// Where long texts are made and compressed.
  Workers describers{};
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
