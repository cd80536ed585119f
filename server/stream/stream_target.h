// Where a stream stops (STREAM.md, "Target"), as bounds on what is sent.
#pragma once

#include <cstdint>

#include "proto/stream_request.h"

namespace qtet {

struct LogIndex;
struct Manifest;

struct StopAt {
  std::uint32_t lastChunk = 0xFFFFFFFFu;  ///< chunks behind it are not sent
  /// Bytes that the client has and gets, the head included. The first chunk is always sent.
  std::uint64_t payload = ~std::uint64_t{0};
  /// Cells of the client's mesh. The base mesh is always sent.
  std::uint64_t tetrahedra = ~std::uint64_t{0};
  bool ofWantedOnly = false;  ///< satisfied once the view's wishes are fulfilled
};

/// A level beyond the last is the last. If the log does not state the errors of its levels, only
/// the last level is known to be good enough. REQUIRES: the manifest is that of the index; `field`
/// is the target's, if it names one, and one of the manifest.
[[nodiscard]] StopAt stopAt(const LogIndex& index, const Manifest& manifest, const Target& target,
                            std::uint32_t field);

}  // namespace qtet
