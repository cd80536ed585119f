// Proof that a log is whole and says of itself what is true: every byte, every record, every count.
#pragma once

#include <functional>

#include "codec/refiner.h"
#include "simplify/opened_log.h"

namespace qtet {

/// Compares every block with its checksum, decodes every chunk with every field, and compares what came out with what manifest and table say: levels,
/// their counts and chunks, the bits of the original's values. `progress` hears the fraction of the chunks that are decoded.
/// The refiner that is returned holds the finest mesh. Errors: bad-checksum, bad-value and all that decoding gives.
[[nodiscard]] Result<Refiner> decodeVerified(const OpenedLog& log, const std::function<void(double fraction)>& progress = {});

}  // namespace qtet
