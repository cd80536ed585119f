// The time and memory that a process used, as far as a module knows.
#pragma once

#include <sys/time.h>

constexpr int RUSAGE_SELF = 0;

struct rusage {
  timeval ru_utime, ru_stime;
  long ru_maxrss;  ///< kB
};

extern "C" int getrusage(int who, rusage* used);
