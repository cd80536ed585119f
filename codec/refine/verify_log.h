// Proof that a log is whole and says of itself what is true: every byte, every record, every count.
#pragma once

#include <functional>

#include "codec/refine/refiner.h"

namespace qtet {

class LogFile;
struct Manifest;

/// Compares every block with its checksum and decodes every chunk with every field. Then compares
/// the result with manifest and table: levels, their counts and chunks, the bits of the original's
/// values. `goOn` receives the fraction of the chunks that are decoded, at every level and after
/// every chunk; returning false ends the work. It needs decodingBytes() of memory.
/// The refiner that is returned holds the finest mesh. REQUIRES: the log's own manifest. Errors:
/// bad-checksum, bad-value and all that decoding gives; io (`goOn` was false).
[[nodiscard]] Result<Refiner> decodeVerified(const LogFile& log, const Manifest& manifest,
                                             const std::function<bool(double fraction)>& goOn = {});

}  // namespace qtet
