// Large arrays in large pages: filling new memory in pages of 4 KB costs a mesh reader as much as its own work (tests/bench/TABLE.md).
#pragma once

#include <sys/mman.h>
#include <unistd.h>

#include <cstdint>
#include <vector>

namespace qtet {

/// Makes room for `count` values, and asks the system for large pages where that is worth it; a system that has none changes nothing.
template <class T>
void reserveInHugePages(std::vector<T>& values, std::size_t count) {
  constexpr std::size_t kWorthBytes = std::size_t{4} << 20;  // two large pages
  values.reserve(count);
  if (count * sizeof(T) < kWorthBytes) return;
  const auto page = static_cast<std::uintptr_t>(::sysconf(_SC_PAGESIZE));
  const std::uintptr_t begin = (reinterpret_cast<std::uintptr_t>(values.data()) + page - 1) / page * page;
  const std::uintptr_t end = reinterpret_cast<std::uintptr_t>(values.data() + values.capacity()) / page * page;
  if (end > begin) ::madvise(reinterpret_cast<void*>(begin), end - begin, MADV_HUGEPAGE);
}

}  // namespace qtet
