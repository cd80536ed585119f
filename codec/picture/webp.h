// Pictures as WebP files.
#pragma once

#include "proto/bytes.h"
#include "proto/error.h"

namespace qtet {

/// `pixels` are red, green, blue and alpha, row by row. `quality` goes from 0 to 100. The same
/// input gives the same bytes. Errors: io (libwebp refused).
/// REQUIRES: 4 * width * height bytes, width and height from 1 to 16,383.
[[nodiscard]] Result<Bytes> encodeWebp(const Bytes& pixels, int width, int height, int quality);

}  // namespace qtet
