// What every connection needs. The objects outlive all connections.
#pragma once

#include <utility>  // before any Asio header: 1.74 uses std::exchange without it

#include <boost/asio/thread_pool.hpp>
#include <chrono>
#include <functional>
#include <string>
#include <vector>

#include "server/access.h"
#include "server/access_log.h"
#include "server/handshakes.h"
#include "server/http_message.h"
#include "server/level_jobs.h"
#include "server/limits.h"
#include "server/mesh_store.h"
#include "server/metrics.h"
#include "server/uploads.h"

namespace qtet {

/// How long a client may take.
struct Timeouts {
  std::chrono::milliseconds header = limits::kHeaderTime;  ///< of a request, or of a handshake with its wait for a place
  std::chrono::milliseconds handshake = limits::kHandshakePatience;
  std::chrono::milliseconds idle = limits::kIdleTime;
  std::chrono::milliseconds write = limits::kWriteTime;
  std::chrono::milliseconds body = limits::kBodyTime;
  std::chrono::milliseconds silence = limits::kSilenceTime;  ///< of a WebSocket
  std::chrono::milliseconds grace = limits::kGraceTime;      ///< of all, once the server ends
};

struct Services {
  const MeshStore& store;
  std::function<Reply(const RequestView&)> route;
  bool streams = true;  ///< WebSockets are answered
  LevelJobs& jobs;
  Metrics& metrics;
  AccessLog* accessLog = nullptr;
  Timeouts timeouts{};
  Uploads* uploads = nullptr;                         ///< where the router knows of uploads
  boost::asio::thread_pool* writers = nullptr;        ///< where meshes are removed
  boost::asio::thread_pool* checkers = nullptr;       ///< where uploads are checked and published, one after the other
  Access* access = nullptr;                           ///< who may read what; nullptr: everybody everything
  const std::vector<std::string>* allowedOrigins = nullptr;  ///< of pages that may open streams; nullptr or empty: any
  Handshakes* handshakes = nullptr;                   ///< where there is TLS
  bool unpaced = false;                               ///< all clients are on this machine, and what is sent to them waits for no timer
};

}  // namespace qtet
