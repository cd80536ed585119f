// Two numbers at once: GNU's vectors, the processor's where it has some (SSE2, WebAssembly's), and
// the same numbers one by one elsewhere, to the bit. Numbers that are read as a pair must be
// written as one. A processor stalls when it loads a pair whose numbers it stored one by one.
#pragma once

#include <cstring>

namespace qtet {

using Pair [[gnu::vector_size(16)]] = double;

/// The numbers at[0] and at[1].
[[nodiscard]] inline Pair pairAt(const double* at) {
  Pair pair;
  std::memcpy(&pair, at, sizeof pair);
  return pair;
}
inline void putPair(double* at, Pair pair) { std::memcpy(at, &pair, sizeof pair); }

}  // namespace qtet
