// From a request to a description of its answer: the whole HTTP interface without a socket
// (PROTOCOL.md, "HTTP").
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "server/http/http_message.h"
#include "server/routes/admin_routes.h"
#include "server/routes/answer.h"
#include "server/routes/kept_pages.h"
#include "server/routes/viewer_files.h"
#include "server/routes/write_routes.h"
#include "server/store/mesh_store.h"
#include "server/wire/document.h"
#include "server/wire/request_target.h"

namespace qtet {

/// Where a WebSocket handshake is to go; anything else there is answered by 426.
inline constexpr std::string_view kStreamPath = "/v1/stream";

/// Thread-safe: immutable after construction, but for pages that guard themselves. Replies hold
/// views into the viewer's files and the router, which must outlive them, and keep the logs that
/// they are about.
class Router {
 public:
  /// `admin` adds the operators' paths. `writing` restricts meshes to those who have a token for
  /// reading or changing them. `admin` and the parts of `writing` must outlive the router.
  /// `frameAncestors` are the pages that may show the viewer in a frame, as CSP writes them.
  Router(const MeshStore& store, const ViewerFiles& viewer, const AdminRoutes* admin = nullptr,
         std::optional<Writing> writing = std::nullopt, const std::string& frameAncestors = "*");

  [[nodiscard]] Answer route(const RequestView& request) const;
  /// Bytes of the pages that are kept.
  [[nodiscard]] std::size_t pageBytes() const { return lists_->bytes() + pages_->bytes(); }

 private:
  [[nodiscard]] Answer find(const RequestView& request, const RequestTarget& target) const;
  [[nodiscard]] Answer api(const RequestView& request, const RequestTarget& target) const;
  [[nodiscard]] Answer logs(const RequestView& request, const RequestTarget& target) const;
  [[nodiscard]] std::optional<Answer> routeWithTokens(const RequestView& request,
                                                      const RequestTarget& target) const;
  [[nodiscard]] Answer meshes(const RequestView& request, const RequestTarget& target) const;
  [[nodiscard]] Reply viewerReply(const RequestView& request, const RequestTarget& target) const;

  const MeshStore& store_;
  const ViewerFiles& viewer_;
  const AdminRoutes* admin_;
  std::optional<Writing> writing_;
  Document openApi_;
  std::unique_ptr<KeptPages> lists_ = std::make_unique<KeptPages>();
  std::unique_ptr<KeptPages> pages_ = std::make_unique<KeptPages>(limits::kMaxMeshPageBytes);
  std::string pagePolicy_, pageLinks_;
};

/// The operators' paths and nothing else, for an address of their own.
[[nodiscard]] Reply routeAdmin(const AdminRoutes& admin, const RequestView& request);

}  // namespace qtet
