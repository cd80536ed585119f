// The version that the C library's functions have had since it first ran on this processor.
#pragma once

#if defined(__x86_64__)
#define QTET_FIRST_VERSION "GLIBC_2.2.5"
#elif defined(__aarch64__)
#define QTET_FIRST_VERSION "GLIBC_2.17"
#else
#error "name the first version of glibc's functions on this processor"
#endif
