// The operators' paths: /livez, /readyz, /metrics and /version (PROTOCOL.md, "For operators").
#pragma once

#include <functional>
#include <vector>

#include "server/http/http_message.h"
#include "server/wire/metrics.h"
#include "server/wire/request_target.h"

namespace qtet {

/// Thread-safe if its sources are.
struct AdminRoutes {
  const Metrics& metrics;
  std::function<bool()> ready;                            ///< new work is welcome
  std::function<std::vector<Metrics::Figure>()> figures;  ///< of now

  /// The answer to GET and HEAD; nullopt: the path is nothing of this.
  [[nodiscard]] std::optional<Reply> route(const RequestTarget& target) const;
};

}  // namespace qtet
