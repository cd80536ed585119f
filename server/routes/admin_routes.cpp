#include "server/routes/admin_routes.h"

#include "codec/log/log_versions.h"
#include "proto/json_reader.h"
#include "proto/messages.h"
#include "proto/version.h"

namespace qtet {
std::optional<Reply> AdminRoutes::route(const RequestTarget& target) const {
  if (target.segments.size() != 1) return std::nullopt;
  const std::string& name = target.segments[0];
  if (name == "livez") return momentaryReply(200, "text/plain; charset=utf-8", "ok\n");
  if (name == "readyz") {
    const std::string_view why = unready();
    if (why.empty()) return momentaryReply(200, "text/plain; charset=utf-8", "ok\n");
    Reply out = problem(503, "busy", why);
    out.headers.add("Retry-After", "2");
    return out;
  }
  if (name == "metrics")
    return momentaryReply(200, "text/plain; version=0.0.4; charset=utf-8", metrics.text(figures()));
  if (name == "version")
    return momentaryReply(200, "application/json",
                          dumpJson({{"version", version()},
                                    {"logFormat", newestLogVersion()},
                                    {"oldestLogFormat", oldestLogVersion()},
                                    {"protocol", kStreamSubprotocol}}));
  return std::nullopt;
}

}  // namespace qtet
