// A loop over independent items on several threads.
#pragma once

#include <algorithm>
#include <cstddef>
#include <thread>
#include <vector>

namespace qtet {

/// Items a thread at least: starting one costs as much as some hundred searches.
inline constexpr std::size_t kItemsPerThread = 512;

/// work(begin, end) over [0, count) in as many runs as threads. REQUIRES: work on one item neither reads nor writes what another one writes, and
/// does not throw.
template <class Work>
void inParallel(std::size_t count, int threads, const Work& work) {
  const std::size_t runs = std::clamp<std::size_t>(count / kItemsPerThread, 1, static_cast<std::size_t>(threads));
  std::vector<std::jthread> others;
  for (std::size_t run = 1; run < runs; ++run) others.emplace_back([&, run] { work(count * run / runs, count * (run + 1) / runs); });
  work(std::size_t{0}, count / runs);
}

}  // namespace qtet
