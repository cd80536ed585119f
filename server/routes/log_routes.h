// Addresses under a digest: the log, its parts and its levels, immutable for ever (PROTOCOL.md,
// "HTTP").
#pragma once

#include "server/routes/answer.h"
#include "server/routes/level_routes.h"
#include "server/wire/request_target.h"

namespace qtet {

/// The answer to `/v1/logs/{sha256}/...`. REQUIRES: at least three segments.
[[nodiscard]] Answer routeLog(const RequestView& request, const RequestTarget& target,
                              const NamedLog& log);

/// A text of the mesh: the reply, or the work of making it where that takes long.
[[nodiscard]] Answer textAnswer(const RequestView& request, const MeshPointer& mesh,
                                ServedMesh::Text which);

}  // namespace qtet
