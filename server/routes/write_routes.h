// PUT and DELETE of /v1/meshes/{id}, and what is there of an upload that broke off: who may, and
// what is asked for.
#pragma once

#include "server/http/uploads.h"
#include "server/routes/answer.h"
#include "server/wire/access.h"
#include "server/wire/request_target.h"

namespace qtet {

/// The router's parts for writing; both outlive it.
struct Writing {
  Access& access;
  Uploads& uploads;
};

/// Whether the path is that of one mesh.
[[nodiscard]] bool isMeshPath(const RequestTarget& target);

/// The answer to a PUT or DELETE on a mesh's path: an upload to be taken, or 400, 401, 403, 404,
/// 411, 415. REQUIRES: isMeshPath(target).
[[nodiscard]] Answer routeWriting(const RequestView& request, const RequestTarget& target,
                                  const Access& access);

/// `/v1/meshes/{id}/upload?digest=HEX` for clients that may write the mesh: {"digest","bytes"},
/// 400, 401, 403 or 404. REQUIRES: such a path.
[[nodiscard]] Reply partialReply(const RequestView& request, const RequestTarget& target,
                                 const Writing& writing);

}  // namespace qtet
