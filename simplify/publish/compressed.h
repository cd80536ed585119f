// Files as web servers send them to browsers that take a coding: gzip and Brotli, as small as they
// get.
#pragma once

#include "proto/bytes.h"
#include "proto/error.h"

namespace qtet {

/// One gzip member, without name and date, so that the same bytes give the same. Errors: io (no
/// memory for it).
[[nodiscard]] Result<Bytes> gzipped(ByteView bytes);

/// A Brotli stream. Errors: as gzipped.
[[nodiscard]] Result<Bytes> brotlied(ByteView bytes);

}  // namespace qtet
