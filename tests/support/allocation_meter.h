// Measures the allocations of a piece of work. It replaces operators new and delete of a program
// that uses it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>

namespace qtet::testing {

/// The largest sum of bytes held at one time by what `work` allocates with new, in all threads,
/// above what was held before.
[[nodiscard]] std::size_t peakBytesOf(const std::function<void()>& work);

/// Bytes held now by what was allocated with new; allocations so far.
[[nodiscard]] std::int64_t heldBytes();
[[nodiscard]] std::uint64_t allocations();

/// Calls work; meanwhile the n-th allocation with new in other threads, from 0, fails as if there
/// were no memory. Under the thread sanitizer none does.
void withoutMemoryInOthers(std::int64_t n, const std::function<void()>& work);

}  // namespace qtet::testing
