#include "tests/support/allocation_meter.h"

#include <malloc.h>

#include <atomic>
#include <cstdint>
#include <cstdlib>
#include <new>

namespace {

std::atomic<std::int64_t> held{0};
std::atomic<std::int64_t> peak{0};
std::atomic<std::uint64_t> count{0};
// allocations in threads that are not spared; negative: none fails
std::atomic<std::int64_t> untilFailure{-1};
thread_local bool isSpared = false;

void failInTurn() {
  if (!isSpared && untilFailure.load() >= 0 && untilFailure.fetch_sub(1) == 0)
    throw std::bad_alloc();
}

void* taken(void* memory) {
  if (memory == nullptr) throw std::bad_alloc();
  const auto bytes = static_cast<std::int64_t>(malloc_usable_size(memory));
  count.fetch_add(1, std::memory_order_relaxed);
  const std::int64_t now = held.fetch_add(bytes) + bytes;
  for (std::int64_t seen = peak.load(); now > seen && !peak.compare_exchange_weak(seen, now);) {
  }
  return memory;
}

void given(void* memory) {
  if (memory != nullptr) held.fetch_sub(static_cast<std::int64_t>(malloc_usable_size(memory)));
  std::free(memory);
}

std::size_t roundedUp(std::size_t bytes, std::size_t alignment) {
  return (bytes + alignment - 1) / alignment * alignment;
}

}  // namespace

// Replaces all forms. A sanitizer's own forms do not call one another, and it reports memory that
// one form allocates and another frees.
void* operator new(std::size_t bytes) {
  failInTurn();
  return taken(std::malloc(bytes == 0 ? 1 : bytes));
}
void* operator new[](std::size_t bytes) { return operator new(bytes); }
void* operator new(std::size_t bytes, const std::nothrow_t&) noexcept {
  void* memory = std::malloc(bytes == 0 ? 1 : bytes);
  return memory == nullptr ? nullptr : taken(memory);
}
void* operator new[](std::size_t bytes, const std::nothrow_t& tag) noexcept {
  return operator new(bytes, tag);
}
void* operator new(std::size_t bytes, std::align_val_t alignment) {
  const auto step = static_cast<std::size_t>(alignment);
  return taken(std::aligned_alloc(step, roundedUp(bytes == 0 ? 1 : bytes, step)));
}
void* operator new[](std::size_t bytes, std::align_val_t alignment) {
  return operator new(bytes, alignment);
}
void operator delete(void* memory) noexcept { given(memory); }
void operator delete[](void* memory) noexcept { given(memory); }
void operator delete(void* memory, std::size_t) noexcept { given(memory); }
void operator delete[](void* memory, std::size_t) noexcept { given(memory); }
void operator delete(void* memory, const std::nothrow_t&) noexcept { given(memory); }
void operator delete[](void* memory, const std::nothrow_t&) noexcept { given(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { given(memory); }
void operator delete[](void* memory, std::align_val_t) noexcept { given(memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { given(memory); }
void operator delete[](void* memory, std::size_t, std::align_val_t) noexcept { given(memory); }

namespace qtet::testing {

std::size_t peakBytesOf(const std::function<void()>& work) {
  const std::int64_t before = held.load();
  peak.store(before);
  work();
  return static_cast<std::size_t>(peak.load() - before);
}

std::int64_t heldBytes() { return held.load(); }

std::uint64_t allocations() { return count.load(); }

void withoutMemoryInOthers(std::int64_t n, const std::function<void()>& work) {
  struct Sparing {
    Sparing() { isSpared = true; }
    ~Sparing() { untilFailure = -1, isSpared = false; }
  } const sparing;
  untilFailure = n;
  work();
}

}  // namespace qtet::testing
