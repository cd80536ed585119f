// What a plan needs to know of a log.
#pragma once

#include "codec/log/log_index.h"
#include "proto/manifest.h"
#include "server/store/packet_intervals.h"

namespace qtet {

/// All of it outlives the call that it is given to.
struct LogFront {
  const LogIndex& index;
  const Manifest& manifest;
  const PacketIntervals* intervals = nullptr;  ///< nullptr: not known (yet)
};

}  // namespace qtet
