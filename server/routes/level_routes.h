// Addresses of levels: `levels/{k}.{form}`, `levels/fit.{form}?tets= | bytes= | error=`, `fields=`
// (PROTOCOL.md, "Levels of detail").
#pragma once

#include "server/http/http_message.h"
#include "server/store/served_mesh.h"
#include "server/wire/request_target.h"

namespace qtet {

/// The answer to `/v1/logs/{sha256}/levels/{name}`: a reply whose body is a LevelRequest, or 304,
/// 400, 404 or 412.
[[nodiscard]] Reply levelReply(const RequestView& request, const RequestTarget& target,
                               const MeshPointer& mesh, std::string_view name);

/// The same for `/v1/logs/{sha256}/preview.png?field=NAME`: the level that is drawn, with the field
/// or the first one of points.
[[nodiscard]] Reply previewReply(const RequestView& request, const RequestTarget& target,
                                 const MeshPointer& mesh);

}  // namespace qtet
