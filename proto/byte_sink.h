// Bytes that go somewhere piece by piece: into memory, a file or a digest.
#pragma once

#include <functional>

#include "proto/bytes.h"

namespace qtet {

/// Takes the next piece. Errors: its own; whoever gives pieces then stops.
using ByteSink = std::function<Status(ByteView)>;
/// Gives pieces to a sink until there are no more, or until the sink fails.
using ByteSource = std::function<Status(const ByteSink&)>;

/// A sink that appends to `bytes`, which must outlive it.
[[nodiscard]] inline ByteSink appendTo(Bytes& bytes) {
  return [&bytes](ByteView piece) -> Status {
    bytes.insert(bytes.end(), piece.begin(), piece.end());
    return {};
  };
}

}  // namespace qtet
