// The answer where a kind of file cannot hold the level or the fields that are asked for.
#pragma once

#include "proto/error.h"
#include "server/http/http_message.h"

namespace qtet {

/// 422 with the writer's message. The options that it names, `fields` and `time` between
/// backquotes, become the parameters fields= and time=.
[[nodiscard]] Reply unwritableLevel(const Error& error);

}  // namespace qtet
