// The list of meshes, page by page (PROTOCOL.md, "HTTP").
#pragma once

#include "server/http/http_message.h"
#include "server/routes/kept_pages.h"
#include "server/store/mesh_store.h"
#include "server/wire/access.h"
#include "server/wire/request_target.h"

namespace qtet {

/// `/v1/meshes?limit=N&after=ID`: N meshes at most, those whose ids come after ID and that may be
/// read. 200, 304, 400 or 412. `kept` keeps the compressed pages.
[[nodiscard]] Reply meshListReply(const RequestView& request, const RequestTarget& target,
                                  const CataloguePointer& catalogue, KeptPages& kept,
                                  const MayRead& mayRead = {});

}  // namespace qtet
