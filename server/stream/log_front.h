// The parts of a log that a plan needs.
#pragma once

namespace qtet {

class PacketIntervals;
struct LogIndex;
struct Manifest;

/// All of it outlives the call that it is given to.
struct LogFront {
  const LogIndex& index;
  const Manifest& manifest;
  const PacketIntervals* intervals = nullptr;  ///< nullptr: not known (yet)
};

}  // namespace qtet
