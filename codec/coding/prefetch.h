// Prefetches memory. A mesh's cells and vertices lie scattered in memory, and waiting for one after
// the other would take a third of a decoder's time.
#pragma once

#include <cstddef>
#include <span>

namespace qtet {

/// Whether prefetch() is an instruction that nothing waits for. WebAssembly has none.
#if defined(__wasm__)
inline constexpr bool kPrefetchIsFree = false;
#else
inline constexpr bool kPrefetchIsFree = true;
#endif

/// A hint that `*at` is read soon. Where prefetching is not free, this reads a byte that nothing
/// uses. A processor looks only some hundred instructions beyond a load that it waits for. So the
/// read pays only if `*at` is certainly read, and soon. REQUIRES: at points to an object or, where
/// it is free, behind the last one of an array.
template <class T>
[[gnu::always_inline]] inline void prefetch(const T* at) {
#if defined(__wasm__)
  (void)*reinterpret_cast<const volatile unsigned char*>(at);
#else
  __builtin_prefetch(at);
  // else g++ takes a function that does nothing but this for one without effect, and leaves its
  // calls out
  asm volatile("");
#endif
}

/// The same of all that a span has.
template <class T>
[[gnu::always_inline]] inline void prefetchAll(std::span<const T> some) {
  constexpr std::size_t kLine = 64;
  const auto bytes = std::as_bytes(some);
  for (std::size_t i = 0; i < bytes.size(); i += kLine) prefetch(&bytes[i]);
  if (!bytes.empty()) prefetch(&bytes.back());
}

}  // namespace qtet
