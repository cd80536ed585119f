// In which order the chunks of a log go to a client: a pure function (STREAM.md, "Order").
#pragma once

#include <cstdint>
#include <vector>

#include "codec/log/target_choice.h"
#include "proto/stream_request.h"
#include "server/stream/client_blocks.h"
#include "server/stream/log_front.h"

namespace qtet {

/// The file's order in `stream`, and for the head of `regions`. Packets are sorted into three
/// groups: wanted by the view, visible, and the rest. In each group packets whose mesh the client
/// has come first, then they are sorted by error per byte. A packet waits for its parent.
[[nodiscard]] std::vector<std::uint32_t> chunkOrder(const LogFront& log, const ClientBlocks& blocks,
                                                    const View& view, const StopAt& stop);

}  // namespace qtet
