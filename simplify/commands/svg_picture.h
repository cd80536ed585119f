// An SVG document in pixels, through librsvg.
#pragma once

#include <string>

#include "proto/bytes.h"
#include "proto/error.h"

namespace qtet {

/// A PNG file of the document, `scale` pixels for each of its own. Errors: bad-input (librsvg's
/// words), io (no memory for the pixels). REQUIRES: scale > 0; the document says its size.
[[nodiscard]] Result<Bytes> pngOf(const std::string& svg, double scale);

}  // namespace qtet
