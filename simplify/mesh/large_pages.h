// The pages that large arrays lie in. A system hands out those of 2 MB in a tenth of the time, and
// a processor finds its way among few of them.
#pragma once

#include <sys/mman.h>

#include <cstdint>
#include <vector>

namespace qtet {

namespace large_pages {

inline constexpr std::uintptr_t kPage = 4096;
// Less is not worth a call.
inline constexpr std::uintptr_t kMinAdvisedBytes = std::uintptr_t{2} << 20;

/// Tells the system something about the whole pages among these bytes.
inline void advise(const void* begin, const void* end, int advice) {
  const auto from = (reinterpret_cast<std::uintptr_t>(begin) + kPage - 1) / kPage * kPage,
             to = reinterpret_cast<std::uintptr_t>(end) / kPage * kPage;
  if (to >= from + kMinAdvisedBytes) ::madvise(reinterpret_cast<void*>(from), to - from, advice);
}

}  // namespace large_pages

/// A hint for the room that the vector has reserved: best given before it is used.
template <class T, class Allocator>
void useLargePages(const std::vector<T, Allocator>& vector) {
  large_pages::advise(vector.data(), vector.data() + vector.capacity(), MADV_HUGEPAGE);
}

/// Gives the memory that the vector has reserved and does not use to the system, until it is used
/// again.
template <class T, class Allocator>
void giveBackRoom(const std::vector<T, Allocator>& vector) {
  large_pages::advise(vector.data() + vector.size(), vector.data() + vector.capacity(),
                      MADV_DONTNEED);
}

}  // namespace qtet
