// Pages of memory for WebAssembly, which has none: no advice is taken, and a file that is mapped is
// read.
#pragma once

#include <cstddef>

constexpr int MADV_HUGEPAGE = 0, MADV_DONTNEED = 0, PROT_READ = 0, MAP_PRIVATE = 0;
#define MAP_FAILED nullptr

inline int madvise(void*, std::size_t, int) { return 0; }

extern "C" {
/// The bytes of the open file from `at` on.
void* mmap(void* wanted, std::size_t bytes, int protection, int flags, int file, long long at);
int munmap(void* memory, std::size_t bytes);
}
