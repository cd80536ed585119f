// The time and memory that a process used, as far as a module knows. METIS includes it from C.
#pragma once

#include <sys/time.h>

enum { RUSAGE_SELF = 0 };

struct rusage {
  struct timeval ru_utime, ru_stime;
  long ru_maxrss;  ///< kB
};

#ifdef __cplusplus
extern "C" {
#endif
int getrusage(int who, struct rusage* used);
#ifdef __cplusplus
}
#endif
