// The manifest of a log, checked against the table that decoding goes by.
#pragma once

#include "codec/log_index.h"
#include "proto/manifest.h"

namespace qtet {

/// Parses the index's manifest. Errors: manifestFromJson's, and bad-value where it contradicts header or chunk table: the lattice's bits, the
/// number of fields, a field's components or association, the number of levels, a level's chunk.
[[nodiscard]] Result<Manifest> manifestOf(const LogIndex& index);

}  // namespace qtet
