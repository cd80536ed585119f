// Makes a level: decodes the log up to it and writes it in the form that is asked for.
#pragma once

#include <stop_token>

#include "proto/byte_sink.h"
#include "proto/error.h"
#include "server/store/level_file.h"
#include "server/store/level_request.h"

namespace qtet {

class SeriesMaker;

/// The file into a sink, or the values of a series where the request has a point: `series` keeps
/// what the next point needs. Looks at `stop` after every chunk; if it was requested, the result is
/// useless. Errors: those of applyChunk, of the writers, of SeriesMaker and of the sink; io when
/// there is not enough memory.
[[nodiscard]] Status writeLevel(const LevelRequest& request, const ByteSink& sink,
                                const std::stop_token& stop, SeriesMaker& series);
/// The whole file.
[[nodiscard]] Result<Bytes> makeLevel(const LevelRequest& request, const std::stop_token& stop);
/// The same in memory of this process.
[[nodiscard]] Result<LevelFile> makeLevelHere(const LevelRequest& request,
                                              const std::stop_token& stop);

}  // namespace qtet
