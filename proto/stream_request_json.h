// Converts a client's blocks and requests to JSON and back. For the .cpp files of this room only,
// like json_reader.h.
#pragma once

#include "proto/json_reader.h"
#include "proto/stream_request.h"
#include "proto/target.h"

namespace qtet {

/// Each reads an absent value as an empty one; errors go to the cursor's.
[[nodiscard]] Have readHave(const JsonCursor& json);
/// Absent and null: everything.
[[nodiscard]] Target readTarget(const JsonCursor& json);

[[nodiscard]] std::optional<StreamTime> readStreamTime(const JsonCursor& json);

[[nodiscard]] Json toJson(const Have& have);
[[nodiscard]] Json toJson(const StreamTime& time);
/// null: everything.
[[nodiscard]] Json toJson(const Target& target);

}  // namespace qtet
