// The router's answer to a request: a finished reply, or one whose body takes work first.
#pragma once

#include <utility>
#include <variant>

#include "server/http/http_message.h"
#include "server/store/level_request.h"
#include "server/store/served_mesh.h"
#include "server/wire/upload_request.h"

namespace qtet {

/// A text of a mesh that takes longer to make than a turn may.
struct TextRequest {
  MeshPointer mesh;
  ServedMesh::Text which = ServedMesh::Text::kDescription;
  bool isPrivate = false;  ///< it is for those who have a token (keepPrivate)
};

/// With a level to be made, `reply` is the head that its bytes go out with. With an upload to be
/// taken, or a text to be made, that alone makes the reply, and this one says nothing.
struct Answer {
  using Work = std::variant<std::monostate, LevelRequest, UploadRequest, TextRequest>;

  // Most answers are one. NOLINTNEXTLINE(google-explicit-constructor)
  Answer(Reply whole) : reply(std::move(whole)) {}
  Answer(Reply head, LevelRequest level) : reply(std::move(head)), work(std::move(level)) {}
  explicit Answer(UploadRequest upload) : work(std::move(upload)) {}
  explicit Answer(TextRequest text) : work(std::move(text)) {}

  Reply reply{};
  Work work{};
};

}  // namespace qtet
