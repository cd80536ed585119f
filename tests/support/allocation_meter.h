// What a piece of work allocates. A program that uses it has its operators new and delete replaced.
#pragma once

#include <cstddef>
#include <functional>

namespace qtet::testing {

/// The largest sum of bytes held at one time by what `work` allocates with new, in all threads, above what was held before.
[[nodiscard]] std::size_t peakBytesOf(const std::function<void()>& work);

}  // namespace qtet::testing
