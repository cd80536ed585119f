// From a request to a description of its answer: the whole HTTP interface without a socket (PROTOCOL.md, "HTTP").
#pragma once

#include <ctime>
#include <map>
#include <string>
#include <string_view>

#include "server/http_message.h"
#include "server/mesh_store.h"
#include "server/request_target.h"
#include "server/viewer_files.h"

namespace qtet {

/// Where a WebSocket handshake is to go; anything else there is answered by 426.
inline constexpr std::string_view kStreamPath = "/v1/stream";

/// Safe to use from any thread. Replies hold views into the store, the viewer's files and the router, which must outlive them.
class Router {
 public:
  Router(const MeshStore& store, const ViewerFiles& viewer);

  [[nodiscard]] Reply route(const RequestView& request) const;

 private:
  /// A body made once, and what it is compared by.
  struct Document {
    std::string text;
    std::string etag;
  };
  static Document makeDocument(std::string text);

  [[nodiscard]] Reply find(const RequestView& request, const RequestTarget& target) const;
  [[nodiscard]] Reply meshReply(const RequestView& request, const RequestTarget& target) const;
  [[nodiscard]] Reply viewerReply(const RequestView& request, const RequestTarget& target) const;
  [[nodiscard]] Reply documentReply(const RequestView& request, const Document& document) const;
  [[nodiscard]] static Reply logReply(const RequestView& request, const RequestTarget& target, const ServedMesh& mesh);
  [[nodiscard]] static Reply levelReply(const RequestView& request, const ServedMesh& mesh, std::string_view name);

  const MeshStore& store_;
  const ViewerFiles& viewer_;
  std::time_t started_;
  Document list_;
  std::map<std::string, Document, std::less<>> meshes_;
};

}  // namespace qtet
