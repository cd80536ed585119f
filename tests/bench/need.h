// For benchmarks, which cannot go on after an error: its text on standard error, and the program
// ends with 1.
#pragma once

#include <cstdio>
#include <cstdlib>
#include <utility>

#include "proto/error.h"

namespace qtet::bench {

inline void need(const Status& status) {
  if (status) return;
  std::fprintf(stderr, "%s\n", status.error().text().c_str());
  std::exit(1);
}

template <class T>
T need(Result<T> result) {
  if (!result) need(Status(std::unexpected(std::move(result.error()))));
  return std::move(*result);
}

}  // namespace qtet::bench
