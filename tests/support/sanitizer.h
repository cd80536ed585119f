// Whether the tests are built with a sanitizer, and how much less the longest of them do then.
#pragma once

#include <cstddef>

namespace qtet::testing {

// g++ defines macros, clang 19 has features.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool kSanitized = true;
#elif defined(__has_feature)
inline constexpr bool kSanitized =
    __has_feature(address_sanitizer) || __has_feature(thread_sanitizer);
#else
inline constexpr bool kSanitized = false;
#endif

/// Tests run only every kStride-th of many similar cases, and divide the size of meshes of millions
/// of cells by it. A sanitizer takes 10 to 50 times as long, and needs no more cases for its finds.
/// It is a prime, so that it meets every bit of a byte and every part of a row.
inline constexpr std::size_t kStride = kSanitized ? 17 : 1;

}  // namespace qtet::testing
