// In which order the chunks of a log go to a client: a pure function (STREAM.md, "Order").
#pragma once

#include <cstdint>
#include <vector>

#include "server/stream/client_blocks.h"
#include "server/stream/log_front.h"
#include "server/stream/stream_target.h"

namespace qtet {

/// In `stream`, and for the head of `regions`: the file's order. Packets: what the view wants, then
/// what is seen, then the rest; in each of them the blocks of meshes that are there already first,
/// then by error per byte. A packet waits for its parent.
[[nodiscard]] std::vector<std::uint32_t> chunkOrder(const LogFront& log, const ClientBlocks& blocks,
                                                    const View& view, const StopAt& stop);

}  // namespace qtet
