// What every connection needs. The objects outlive all connections.
#pragma once

#include <utility>  // before any Asio header: 1.74 uses std::exchange without it

#include <boost/asio/thread_pool.hpp>
#include <chrono>
#include <functional>
#include <string>
#include <vector>

#include "server/access_log.h"
#include "server/http_message.h"
#include "server/level_jobs.h"
#include "server/limits.h"
#include "server/mesh_store.h"
#include "server/metrics.h"
#include "server/uploads.h"

namespace qtet {

/// How long a client may take.
struct Timeouts {
  std::chrono::milliseconds header = limits::kHeaderTime;
  std::chrono::milliseconds idle = limits::kIdleTime;
  std::chrono::milliseconds write = limits::kWriteTime;
  std::chrono::milliseconds body = limits::kBodyTime;
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
  boost::asio::thread_pool* verifiers = nullptr;      ///< where they are checked
  const std::vector<std::string>* allowedOrigins = nullptr;  ///< of pages that may open streams; nullptr or empty: any
};

}  // namespace qtet
