// The log that a server has under a mesh's name, as far as a delta to it needs.
#pragma once

#include <string>

#include "codec/log/log_index.h"
#include "simplify/remote/http_client.h"

namespace qtet {

struct OldLog {
  std::string digest;
  LogIndex index;  ///< with its later instants
};

/// Fetches the front of a mesh's log and its later instants, by ranges. `request` is that for the
/// mesh's description, and all are made like it. Errors: exchange's, not-found (no such mesh), io
/// (another answer than is expected), limit-exceeded, LogIndex's.
[[nodiscard]] Result<OldLog> fetchOldLog(const HttpUrl& server, const HttpRequest& request);

}  // namespace qtet
