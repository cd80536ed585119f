// How much less the longest tests do when they are built with a sanitizer.
#pragma once

#include <cstddef>

#include "proto/sanitizer.h"

namespace qtet::testing {

using qtet::kSanitized;

/// Tests run only every kStride-th of many similar cases, and divide the size of meshes of millions
/// of cells by it. A sanitizer takes 10 to 50 times as long, and needs no more cases for its finds.
/// It is a prime, so that it meets every bit of a byte and every part of a row.
inline constexpr std::size_t kStride = kSanitized ? 17 : 1;

}  // namespace qtet::testing
