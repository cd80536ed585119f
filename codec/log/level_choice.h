// Which level somebody means who says how large or how good it has to be. Figures are the
// manifest's.
#pragma once

#include <cstdint>

#include "proto/error.h"

namespace qtet {

struct LogIndex;
struct Manifest;

/// The finest level of at most `most` tetrahedra; 0 if there is none.
[[nodiscard]] std::uint32_t levelOfTetrahedra(const Manifest& manifest, double most);
/// The finest level that a prefix of at most `most` bytes of the file holds; 0 if there is none.
/// REQUIRES: a manifest that manifestOf(index) gave.
[[nodiscard]] std::uint32_t levelOfBytes(const Manifest& manifest, const LogIndex& index,
                                         std::uint64_t most);
/// The coarsest level whose boundary is known to be nowhere further than `bound` from the
/// original's, both ways. The bound is a fraction of the diagonal. If there is none, the last one.
/// Errors: not-found (no level's error is known).
[[nodiscard]] Result<std::uint32_t> levelOfBoundaryError(const Manifest& manifest, double bound);
/// The coarsest level at which a field's rms error is known to be at most `bound`, a fraction of
/// its range. Else as above. REQUIRES: a field of the manifest.
[[nodiscard]] Result<std::uint32_t> levelOfFieldError(const Manifest& manifest, std::size_t field,
                                                      double bound);

}  // namespace qtet
