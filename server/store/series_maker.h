// The values of a series at one point, as JSON or CSV (PROTOCOL.md, "Values over time").
#pragma once

#include <stop_token>

#include "proto/bytes.h"
#include "proto/error.h"
#include "server/store/level_request.h"

namespace qtet {

/// The whole text. Decodes the mesh up to the level, then the request's fields and their parents,
/// one after the other. Looks at `stop` after every chunk and every block of a field. Errors:
/// not-found (the point lies in no cell; the message has the mesh's box), those of applyChunk, io
/// (stopped). REQUIRES: a request with a point, the form kJson or kCsv, and fields that are
/// instants of one series or one field.
[[nodiscard]] Result<Bytes> makeSeries(const LevelRequest& request, const std::stop_token& stop);

}  // namespace qtet
