// `time=` of a level: its file has one instant of each series, as `qtet extract --time` writes it.
#pragma once

#include <string>

#include "server/routes/level_answer.h"

namespace qtet {

/// Leaves the request those of its fields that `asked` means: a time of the series among them
/// (placeOfTime), `first` or `last`. Instants get the names of Instants::fileAt. Refusals: 400
/// (none of these), 404 (no instant of that time).
[[nodiscard]] OrRefusal<LevelRequest> atTime(LevelRequest wanted, const std::string& asked);

}  // namespace qtet
