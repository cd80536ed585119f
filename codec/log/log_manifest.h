// The manifest in a log, both ways (FORMAT.md, "Manifest"). The manifest does not repeat header and
// chunk table, so it cannot contradict them. Only whether a field has missing values is stored in
// both.
#pragma once

#include <cstdint>

#include "proto/bytes.h"
#include "proto/error.h"
#include "proto/manifest.h"

namespace qtet {

struct LogIndex;

/// The bytes of LogIndex::manifest. Errors are rounded up to three significant digits
/// (codec/coding/error_figure.h). If a level has one, the first and the last have one. Errors:
/// bad-value (an error that is no number or out of range, a name too long), limit-exceeded (above
/// kMaxManifestBytes). REQUIRES: at least one level.
[[nodiscard]] Result<Bytes> manifestBlock(const Manifest& manifest);

/// The least minor version of the format that has what manifestBlock writes.
/// REQUIRES: at least one level.
[[nodiscard]] std::uint16_t minorOf(const Manifest& manifest);

/// Reads index.manifest. The rest of the index gives bits of the lattice, shapes of the
/// fields, the number of levels and each level's chunk. Errors: truncated; limit-exceeded (found
/// before anything is allocated); bad-value with what is out of range, and for bytes left over.
[[nodiscard]] Result<Manifest> manifestOf(const LogIndex& index);

}  // namespace qtet
