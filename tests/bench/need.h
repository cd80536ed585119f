// For benchmarks: an error ends the program with 1, and its text goes to standard error.
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
