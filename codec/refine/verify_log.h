// Proof that a log is whole and says of itself what is true: every byte, every record, every count.
#pragma once

#include <cstdint>
#include <functional>

#include "codec/refine/refiner.h"

namespace qtet {

class LogFile;
struct Manifest;

/// The part that stays in memory when a log is verified.
enum class Verified : std::uint8_t {
  kMesh,    ///< the finest mesh. Fields are decoded one after the other, and forgotten.
  kFields,  ///< its fields, too
};

/// Compares every block with its checksum and decodes every chunk with every field. Then compares
/// the result with manifest and table: levels, their counts and chunks, the bits of the original's
/// values. `goOn` receives the fraction of the bytes that are decoded, at every level and after
/// every block. It returns false to end the work. Decoding needs decodingBytes() of memory at most.
/// The refiner that is returned holds the finest mesh. REQUIRES: the log's own manifest. Errors:
/// bad-checksum, bad-value and all that decoding gives; io (`goOn` was false).
[[nodiscard]] Result<Refiner> decodeVerified(const LogFile& log, const Manifest& manifest,
                                             const std::function<bool(double fraction)>& goOn = {},
                                             Verified left = Verified::kMesh);

}  // namespace qtet
