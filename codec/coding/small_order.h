// A stable order of at most four things: what std::stable_sort would do with an allocation.
#pragma once

#include <array>
#include <cassert>
#include <cstddef>

namespace qtet {

/// Indices 0..n-1 so that before(a, b) never holds for a standing after b; equals keep their order.
/// REQUIRES n <= 4.
template <class Before>
[[nodiscard]] std::array<std::size_t, 4> smallOrder(std::size_t n, const Before& before) {
  std::array<std::size_t, 4> order{};
  assert(n <= order.size());
  for (std::size_t i = 0; i < n; ++i) {
    std::size_t at = i;
    for (; at > 0 && before(i, order[at - 1]); --at) order[at] = order[at - 1];
    order[at] = i;
  }
  return order;
}

}  // namespace qtet
