// The check of a log that somebody sent, before anybody sees it: decoded whole, within bounds of
// memory and time.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <stop_token>

#include "server/http/http_message.h"
#include "server/http/upload_limits.h"
#include "server/store/served_mesh.h"

namespace qtet {

struct CheckLimits {
  /// Memory, as predicted by codec/log/decoding_memory.h.
  std::uintmax_t bytes = limits::kMaxCheckBytes;
  std::chrono::milliseconds time = limits::kCheckTime;  ///< of one check, from its own beginning
};

/// Returns nullopt if every record and the values of every field decode and agree with the
/// manifest. Else returns the answer: 413 (beyond the limits, with the figure), 422 (bad-log, with
/// the fault and its place), 503 (there is no memory just now, or `stop` was requested; looked at
/// before every level and after every chunk).
[[nodiscard]] std::optional<Reply> checkLog(const ServedMesh& mesh, const CheckLimits& limits,
                                            const std::stop_token& stop);
using LogCheck = std::function<std::optional<Reply>(const ServedMesh&, const CheckLimits&,
                                                    const std::stop_token&)>;

}  // namespace qtet
