// Routes and methods as labels of figures: few and fixed, so that no client makes new ones.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace qtet {

enum class RouteLabel : std::uint8_t {
  kOther,    ///< no target that is understood
  kViewer,   ///< the page and its files, and openapi.json
  kAdmin,    ///< /livez, /readyz, /metrics, /version
  kMeshes,   ///< /v1/meshes
  kMesh,     ///< /v1/meshes/{id} and below
  kLog,      ///< /v1/logs/{sha256}/... but levels, series and poster
  kLevel,    ///< /v1/logs/{sha256}/levels/...
  kSeries,   ///< /v1/logs/{sha256}/series
  kPoster,   ///< /v1/logs/{sha256}/poster.webp
  kTickets,  ///< /v1/tickets
  kStream,   ///< /v1/stream, where it becomes no WebSocket
};
inline constexpr std::array<std::string_view, 11> kRouteLabels = {
    "other", "viewer", "admin",  "meshes",  "mesh",  "log",
    "level", "series", "poster", "tickets", "stream"};
/// The last one stands for all others.
inline constexpr std::array<std::string_view, 7> kMethodLabels = {
    "GET", "HEAD", "PUT", "POST", "DELETE", "OPTIONS", "other"};

struct RequestKind {
  RouteLabel route = RouteLabel::kOther;
  std::size_t method = kMethodLabels.size() - 1;  ///< its place in kMethodLabels

  [[nodiscard]] bool isUpload() const {
    return route == RouteLabel::kMesh && kMethodLabels[method] == "PUT";
  }
};

[[nodiscard]] RequestKind kindOf(std::string_view method, std::string_view target);

}  // namespace qtet
