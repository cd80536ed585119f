// The level and the chunks that a target takes of a log. Tool, server and C API choose by cells,
// bytes, errors or levels here alone. Figures are the manifest's.
#pragma once

#include <cstdint>

#include "proto/error.h"
#include "proto/target.h"

namespace qtet {

struct LogIndex;
struct Manifest;

/// The finest level of at most so many tetrahedra; 0 if there is none. By bytes the finest level
/// that a prefix of at most so many bytes of the file holds; 0 if there is none. By errors the
/// coarsest level that is known to be good enough, both ways for the boundary, or the last one. A
/// level beyond the last is the last, and so is everything's. Errors: not-found (no such field; no
/// level's error is known). REQUIRES: a manifest that manifestOf(index) gave.
[[nodiscard]] Result<std::uint32_t> levelFor(const Target& target, const Manifest& manifest,
                                             const LogIndex& index);

/// Where a stream of chunks ends, as bounds on what is sent.
struct StopAt {
  std::uint32_t lastChunk = 0xFFFFFFFFu;  ///< chunks behind it are not sent
  /// Bytes that the client has and gets, the head included. The first chunk is always sent.
  std::uint64_t payload = ~std::uint64_t{0};
  /// Cells of the client's mesh. The base mesh is always sent.
  std::uint64_t tetrahedra = ~std::uint64_t{0};
  bool ofWantedOnly = false;  ///< satisfied once the view's wishes are fulfilled
};

/// The chunks of levelFor. Bytes are counted in whole chunks, not in levels. In the layout
/// `regions` bytes and cells bound what a view takes. If no level's error is known, the last level
/// is good enough. Errors: not-found (no such field). REQUIRES: as levelFor.
[[nodiscard]] Result<StopAt> chunksFor(const Target& target, const Manifest& manifest,
                                       const LogIndex& index);

}  // namespace qtet
