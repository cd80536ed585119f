// Addresses of levels: `levels/{k}.{form}`, `levels/fit.{form}?tets= | bytes= | error=`, `fields=`,
// `time=` (PROTOCOL.md, "Levels of detail").
#pragma once

#include "server/routes/answer.h"
#include "server/store/served_mesh.h"
#include "server/wire/request_target.h"

namespace qtet {

/// A log, and one of its names that the client may know. Saved files get this name.
struct NamedLog {
  MeshPointer mesh;
  std::string name;
};

/// The answer to `/v1/logs/{sha256}/levels/{level}`: a level to be made, or 304, 400, 404,
/// 412 or 422.
[[nodiscard]] Answer routeLevel(const RequestView& request, const RequestTarget& target,
                                const NamedLog& log, std::string_view level);

/// The same for `/v1/logs/{sha256}/poster.webp` (codec/picture/poster.h).
[[nodiscard]] Answer routePoster(const RequestView& request, const NamedLog& log);

}  // namespace qtet
