// Pages of memory for WebAssembly, which has none: no advice is taken, and no file is mapped.
#pragma once

#include <cstddef>

constexpr int MADV_HUGEPAGE = 0, MADV_DONTNEED = 0, PROT_READ = 0, MAP_PRIVATE = 0;
#define MAP_FAILED nullptr

inline int madvise(void*, std::size_t, int) { return 0; }
inline void* mmap(void*, std::size_t, int, int, int, long long) { return MAP_FAILED; }
inline int munmap(void*, std::size_t) { return 0; }
