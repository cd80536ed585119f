// The operators' paths: /livez, /readyz, /metrics and /version (PROTOCOL.md, "For operators").
#pragma once

#include <functional>
#include <string_view>
#include <vector>

#include "server/http/http_message.h"
#include "server/wire/metrics.h"
#include "server/wire/request_target.h"

namespace qtet {

/// Immutable after construction, so thread-safe if its sources are.
struct AdminRoutes {
  const Metrics& metrics;
  std::function<std::string_view()> unready;  ///< why new work is not welcome; "": it is
  std::function<std::vector<Metrics::Figure>()> figures;  ///< of now

  /// The answer to GET and HEAD; nullopt: the path is nothing of this.
  [[nodiscard]] std::optional<Reply> route(const RequestTarget& target) const;
};

}  // namespace qtet
