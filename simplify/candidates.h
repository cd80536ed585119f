// The candidates of each vertex: the edges that it owns, cheapest first. What was tried and failed stays, to be tried again.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "codec/fetch.h"
#include "codec/mesh.h"

namespace qtet {

struct Candidate {
  float key = 0;
  VertexId partner = 0;
  bool operator<(const Candidate& other) const { return std::pair(key, partner) < std::pair(other.key, other.partner); }
};

class Candidates {
 public:
  void clear() {
    pool_.clear();
    lists_.clear();
    live_ = 0;
  }

  /// The candidates of `owner`. REQUIRES: sorted.
  void set(VertexId owner, std::span<const Candidate> found) {
    if (lists_.size() <= owner) lists_.resize(std::size_t{owner} + 1);
    live_ += found.size() - lists_[owner].count;
    lists_[owner] = {pool_.size(), 0, static_cast<std::uint32_t>(found.size())};
    pool_.insert(pool_.end(), found.begin(), found.end());
  }

  /// The cheapest that has not failed, or none. Valid until set or compact.
  [[nodiscard]] const Candidate* best(VertexId owner) const {
    if (owner >= lists_.size()) return nullptr;
    const List& list = lists_[owner];
    return list.next < list.count ? &pool_[list.first + list.next] : nullptr;
  }
  /// Ask the memory for the owner's list, and then for what best() looks at.
  void prefetch(VertexId owner) const {
    if (owner < lists_.size()) fetch(&lists_[owner]);
  }
  void prefetchBest(VertexId owner) const {
    if (owner < lists_.size()) fetch(pool_.data() + lists_[owner].first + lists_[owner].next);
  }
  /// The best one and all after it.
  [[nodiscard]] std::span<const Candidate> remaining(VertexId owner) const {
    if (owner >= lists_.size()) return {};
    const List& list = lists_[owner];
    return std::span(pool_).subspan(list.first + list.next, list.count - list.next);
  }
  /// The best one is not legal: on to the next. REQUIRES: best(owner).
  void fail(VertexId owner) {
    List& list = lists_[owner];
    pool_[list.first + list.next++].key *= kFailed;
  }
  /// The best one is gone for good: on to the next. Threads may do so at once, each for owners of its own. REQUIRES: best(owner).
  void drop(VertexId owner) {
    List& list = lists_[owner];
    pool_[list.first + list.next] = pool_[list.first];  // of those that failed the order does not count
    ++list.first, --list.count;
    std::atomic_ref(live_).fetch_sub(1, std::memory_order_relaxed);
  }
  /// All that failed may be tried again, in their turn.
  void restart(VertexId owner) {
    if (owner >= lists_.size() || lists_[owner].next == 0) return;
    List& list = lists_[owner];
    list.next = 0;
    const auto first = pool_.begin() + static_cast<std::ptrdiff_t>(list.first);
    std::sort(first, first + list.count);
  }
  /// The best one costs `key`, more than was known. REQUIRES: best(owner).
  void raise(VertexId owner, float key) {
    const List& list = lists_[owner];
    std::size_t i = list.first + list.next;
    pool_[i].key = key;
    for (; i + 1 < list.first + list.count && pool_[i + 1] < pool_[i]; ++i) std::swap(pool_[i], pool_[i + 1]);
  }

  /// The owner is dead: all of its candidates are gone.
  void forget(VertexId owner) {
    if (owner >= lists_.size()) return;
    live_ -= lists_[owner].count;
    lists_[owner] = {};
  }

  /// Gives back the room of what is gone, when it is half of all.
  void compact() {
    if (pool_.size() < 2 * live_ + 4096) return;
    std::vector<Candidate> kept;
    kept.reserve(live_ + live_ / 4);
    for (List& list : lists_) {
      const std::size_t first = kept.size();
      kept.insert(kept.end(), pool_.begin() + static_cast<std::ptrdiff_t>(list.first),
                  pool_.begin() + static_cast<std::ptrdiff_t>(list.first + list.count));
      list.first = first;
    }
    pool_ = std::move(kept);
  }

 private:
  // What was not legal is tried again later than its cost says: what forbade it is seldom gone after one change nearby.
  static constexpr float kFailed = 4;

  struct List {
    std::size_t first = 0;
    std::uint32_t next = 0, count = 0;
  };
  std::vector<Candidate> pool_;
  std::vector<List> lists_;
  std::size_t live_ = 0;
};

}  // namespace qtet
