// Debian's static HDF5 is compiled for programs. It takes the C library's standard streams from a
// fixed place beside its code, which a shared library does not have. The linker's --wrap leads all
// uses of `stderr` and `stdout` to these copies, also those of the C++ library.
#include <cstdio>

extern "C" {
extern FILE* const kRealError asm("__real_stderr");
extern FILE* const kRealOutput asm("__real_stdout");
extern FILE* wrappedError asm("__wrap_stderr");
extern FILE* wrappedOutput asm("__wrap_stdout");
FILE* wrappedError = nullptr;
FILE* wrappedOutput = nullptr;
}

namespace {

/// Before std::cout is made, which takes its stream then. Since g++ 13 that has priority 90, among
/// those that g++ keeps for itself.
constexpr int kBeforeAll = 89;
#ifndef __clang__
#pragma GCC diagnostic ignored "-Wprio-ctor-dtor"
#endif

__attribute__((constructor(kBeforeAll))) void copyStreams() {
  wrappedError = kRealError;
  wrappedOutput = kRealOutput;
}

}  // namespace
