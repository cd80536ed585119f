#include "server/wire/request_kind.h"

#include <algorithm>
#include <optional>

#include "server/wire/request_target.h"

namespace qtet {
namespace {

RouteLabel routeOfApi(const RequestTarget& target) {
  const auto& path = target.segments;
  if (path.size() < 2) return RouteLabel::kOther;
  if (path[1] == "tickets") return RouteLabel::kTickets;
  if (path[1] == "stream") return RouteLabel::kStream;
  if (path[1] == "meshes") return path.size() == 2 ? RouteLabel::kMeshes : RouteLabel::kMesh;
  if (path[1] != "logs") return RouteLabel::kOther;
  if (path.size() > 3 && path[3] == "levels") return RouteLabel::kLevel;
  if (path.size() > 3 && path[3] == "series") return RouteLabel::kSeries;
  const bool isPoster = path.size() > 3 && path[3] == "poster.webp";
  return isPoster ? RouteLabel::kPoster : RouteLabel::kLog;
}

RouteLabel routeOf(std::string_view text) {
  const std::optional<RequestTarget> target = parseTarget(text);
  if (!target || target->segments.empty()) return RouteLabel::kOther;
  const std::string& first = target->segments[0];
  if (first == "v1") return routeOfApi(*target);
  constexpr std::array<std::string_view, 4> kAdmin = {"livez", "readyz", "metrics", "version"};
  return target->segments.size() == 1 && std::ranges::find(kAdmin, first) != kAdmin.end()
             ? RouteLabel::kAdmin
             : RouteLabel::kViewer;
}

}  // namespace

RequestKind kindOf(std::string_view method, std::string_view target) {
  const auto found = std::ranges::find(kMethodLabels, method);
  const bool known = found != kMethodLabels.end();
  return {routeOf(target), known ? static_cast<std::size_t>(found - kMethodLabels.begin())
                                 : kMethodLabels.size() - 1};
}

}  // namespace qtet
