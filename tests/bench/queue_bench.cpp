// Finds the priority queue that suits the simplifier: Boost's Fibonacci heap (the paper's choice),
// pairing and d-ary heaps, and bucket queues, under the operations of queue_trace.h. Prints a
// Markdown table of ns an operation, a push or a pop; results in QUEUES.md.
//   queue_bench [--repeats N] [VERTICES...] (without any: 50000 200000; 2000000 takes 600 MB and
//   some minutes)
#include <algorithm>
#include <array>
#include <bit>
#include <boost/heap/d_ary_heap.hpp>
#include <boost/heap/fibonacci_heap.hpp>
#include <boost/heap/pairing_heap.hpp>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "tests/bench/cpu_clock.h"
#include "tests/bench/parts/queue_trace.h"

namespace qtet::bench {
namespace {

/// Boost's heaps keep the largest on top.
struct After {
  bool operator()(const QueueEntry& a, const QueueEntry& b) const { return b.isBefore(a); }
};

template <class Heap>
class Boosted {
 public:
  void push(const QueueEntry& entry) { heap_.push(entry); }
  QueueEntry pop() {
    const QueueEntry top = heap_.top();
    heap_.pop();
    return top;
  }

 private:
  Heap heap_;
};

using Fibonacci = Boosted<boost::heap::fibonacci_heap<QueueEntry, boost::heap::compare<After>>>;
using Pairing = Boosted<boost::heap::pairing_heap<QueueEntry, boost::heap::compare<After>>>;
template <unsigned arity>
using DAry = Boosted<
    boost::heap::d_ary_heap<QueueEntry, boost::heap::arity<arity>, boost::heap::compare<After>>>;

/// Buckets by the leading bits of the key, which as bits of a positive float are in the order of
/// their values. Exact: a heap in each bucket; otherwise its last entry goes first, out of order by
/// less than a bucket's width.
template <bool exact>
class Buckets {
 public:
  static constexpr int kMantissaBits = 6;  // a bucket is 2^-6 = 1.6 % wide
  static constexpr int kShift = 23 - kMantissaBits;

  Buckets() : buckets_(std::size_t{1} << (31 - kShift)), occupied_(buckets_.size() / 64) {}

  void push(const QueueEntry& entry) {
    const std::size_t at = std::bit_cast<std::uint32_t>(entry.key) >> kShift;
    buckets_[at].push_back(entry);
    if constexpr (exact) std::ranges::push_heap(buckets_[at], After{});
    occupied_[at / 64] |= std::uint64_t{1} << at % 64;
    lowest_ = std::min(lowest_, at / 64);
  }
  QueueEntry pop() {
    while (occupied_[lowest_] == 0) ++lowest_;
    const std::size_t at =
        64 * lowest_ + static_cast<std::size_t>(std::countr_zero(occupied_[lowest_]));
    std::vector<QueueEntry>& bucket = buckets_[at];
    if constexpr (exact) std::ranges::pop_heap(bucket, After{});
    const QueueEntry top = bucket.back();
    bucket.pop_back();
    if (bucket.empty()) occupied_[lowest_] &= occupied_[lowest_] - 1;
    return top;
  }

 private:
  std::vector<std::vector<QueueEntry>> buckets_;
  std::vector<std::uint64_t> occupied_;  // a bit a bucket
  std::size_t lowest_ = 0;               // word of occupied_: those before are zero
};

struct Contender {
  const char* name;
  bool exact;
  std::uint64_t (*replay)(const std::vector<QueueEntry>& operations);
};

/// Returns the checksum of what was popped.
template <class Queue>
std::uint64_t replay(const std::vector<QueueEntry>& operations) {
  Queue queue;
  std::uint64_t checksum = 0;
  for (const QueueEntry& entry : operations) {
    if (entry.key == QueueTrace::kPop) {
      checksum = withPopped(checksum, queue.pop().owner);
    } else {
      queue.push(entry);
    }
  }
  return checksum;
}

constexpr std::array kContenders{
    Contender{"Fibonacci heap (Boost)", true, replay<Fibonacci>},
    Contender{"pairing heap (Boost)", true, replay<Pairing>},
    Contender{"2-ary heap (Boost)", true, replay<DAry<2>>},
    Contender{"4-ary heap (Boost)", true, replay<DAry<4>>},
    Contender{"8-ary heap (Boost)", true, replay<DAry<8>>},
    Contender{"buckets, a heap in each", true, replay<Buckets<true>>},
    Contender{"buckets, 1.6 % out of order", false, replay<Buckets<false>>}};

bool compare(std::uint32_t vertices, int repeats) {
  const QueueTrace trace = recordQueueTrace(vertices);
  const auto percent = [&](std::uint64_t n) {
    return 100 * static_cast<double>(n) / static_cast<double>(trace.pops);
  };
  std::printf(
      "\n%u vertices: %zu operations in %llu levels; of the pops %.0f %% dead, %.0f %% gone, %.0f "
      "%% locked, %.0f %% illegal, %.0f %% "
      "fused\n\n",
      vertices, trace.operations.size(), static_cast<unsigned long long>(trace.levels),
      percent(trace.dead), percent(trace.gone), percent(trace.locked), percent(trace.illegal),
      percent(trace.fused));
  std::array<std::vector<double>, kContenders.size()> seconds;
  for (int i = 0; i < repeats; ++i)
    for (std::size_t c = 0; c < kContenders.size(); ++c) {
      std::uint64_t checksum = 0;
      seconds[c].push_back(
          timeOf([&] { checksum = kContenders[c].replay(trace.operations); }).user);
      if (kContenders[c].exact && checksum != trace.checksum) {
        std::fprintf(stderr, "queue_bench: %s pops in another order than the model did\n",
                     kContenders[c].name);
        return false;
      }
    }
  std::puts("| queue | ns an operation | of the 4-ary heap's |\n|---|---|---|");
  for (std::size_t c = 0; c < kContenders.size(); ++c)
    std::printf("| %s | %.1f | %.2f |\n", kContenders[c].name,
                1e9 * medianOf(seconds[c]) / static_cast<double>(trace.operations.size()),
                medianOf(seconds[c]) / medianOf(seconds[3]));
  std::fflush(stdout);
  return true;
}

}  // namespace
}  // namespace qtet::bench

int main(int argc, char** argv) {
  int repeats = 5;
  std::vector<std::uint32_t> sizes;
  for (int i = 1; i < argc; ++i) {
    const bool isRepeats = std::string(argv[i]) == "--repeats";
    const long value = std::strtol(argv[isRepeats && i + 1 < argc ? ++i : i], nullptr, 10);
    if (value < 1 || (!isRepeats && (value < 1000 || value > 100000000))) {
      std::fputs("usage: queue_bench [--repeats N] [VERTICES...], from 1000 vertices\n", stderr);
      return EXIT_FAILURE;
    }
    isRepeats ? void(repeats = static_cast<int>(value))
              : sizes.push_back(static_cast<std::uint32_t>(value));
  }
  if (!qtet::bench::pinToCores(1))
    std::fputs("queue_bench: the system refuses to pin the process to a core\n", stderr);
  for (const std::uint32_t vertices :
       sizes.empty() ? std::vector<std::uint32_t>{50000, 200000} : sizes)
    if (!qtet::bench::compare(vertices, repeats)) return EXIT_FAILURE;
  return EXIT_SUCCESS;
}
