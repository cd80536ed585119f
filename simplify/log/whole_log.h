// Logs whose last level is not their input's mesh: what compares with the input refuses them.
#pragma once

#include "proto/error.h"
#include "proto/manifest.h"

namespace qtet {

/// Error: bad-input (the last level was reduced from the input, Manifest::original).
[[nodiscard]] Status checkWhole(const Manifest& manifest);

}  // namespace qtet
