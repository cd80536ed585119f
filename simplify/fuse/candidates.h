// The candidates of each vertex: the edges that it owns, cheapest first. A candidate that failed
// stays, to be tried again.
#pragma once

#include <algorithm>
#include <atomic>
#include <cassert>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "codec/coding/prefetch.h"
#include "codec/mesh/mesh.h"
#include "simplify/mesh/large_pages.h"
#include "simplify/mesh/workers.h"

namespace qtet {

struct Candidate {
  float key = 0;
  VertexId partner = 0;
  bool operator<(const Candidate& other) const {
    return std::pair(key, partner) < std::pair(other.key, other.partner);
  }
};

class Candidates {
 public:
  void clear() {
    pool_.clear();
    lists_.clear();
    live_ = 0;
  }

  /// Room for so many, so that they seldom move.
  void reserve(std::size_t candidates) {
    pool_.reserve(candidates);
    useLargePages(pool_);
  }

  /// The candidates of owners, one after the other. REQUIRES: each sorted; owners ascend, and from
  /// every one before.
  void set(std::span<const VertexId> owners, std::span<const std::vector<Candidate>> found,
           Workers& workers) {
    if (owners.empty()) return;
    assert(lists_.size() <= owners.front());
    assert(found.size() >= owners.size());
    lists_.resize(std::size_t{owners.back()} + 1);
    const std::size_t before = pool_.size();
    std::size_t end = before;
    for (std::size_t i = 0; i < owners.size(); ++i) {
      assert(i == 0 || owners[i - 1] < owners[i]);
      lists_[owners[i]] = {end, 0, static_cast<std::uint32_t>(found[i].size())};
      end += found[i].size();
    }
    live_ += end - before;
    pool_.resize(end);
    workers.forRuns(owners.size(), kSetAtOnce, [&](std::size_t first, std::size_t last) {
      for (std::size_t i = first; i < last; ++i)
        std::ranges::copy(found[i],
                          pool_.begin() + static_cast<std::ptrdiff_t>(lists_[owners[i]].first));
    });
  }

  /// The cheapest that has not failed, or none. Valid until something changes.
  [[nodiscard]] const Candidate* best(VertexId owner) const {
    if (owner >= lists_.size()) return nullptr;
    const List& list = lists_[owner];
    assert(list.next <= list.count && list.first + list.count <= pool_.size());
    return list.next < list.count ? &pool_[list.first + list.next] : nullptr;
  }
  /// Ask the memory for the owner's list, and then for what best() looks at.
  void prefetch(VertexId owner) const {
    if (owner < lists_.size()) qtet::prefetch(&lists_[owner]);
  }
  void prefetchBest(VertexId owner) const {
    if (owner < lists_.size())
      qtet::prefetch(pool_.data() + lists_[owner].first + lists_[owner].next);
  }
  /// It has none, nor will have.
  [[nodiscard]] bool isEmpty(VertexId owner) const {
    return owner >= lists_.size() || lists_[owner].count == 0;
  }
  /// Some have failed since they were set or restarted.
  [[nodiscard]] bool hasFailed(VertexId owner) const {
    return owner < lists_.size() && lists_[owner].next > 0;
  }
  /// The best one and all after it.
  [[nodiscard]] std::span<const Candidate> remaining(VertexId owner) const {
    if (owner >= lists_.size()) return {};
    const List& list = lists_[owner];
    return std::span(pool_).subspan(list.first + list.next, list.count - list.next);
  }
  /// The best one is not legal: on to the next. REQUIRES: best(owner).
  void fail(VertexId owner) {
    assert(best(owner));
    List& list = lists_[owner];
    pool_[list.first + list.next++].key *= kFailed;
  }
  /// The best one is gone for good: on to the next. Threads may do so at once, each for owners of
  /// its own. REQUIRES: best(owner).
  void drop(VertexId owner) {
    assert(best(owner));
    List& list = lists_[owner];
    // of those that failed the order does not count
    pool_[list.first + list.next] = pool_[list.first];
    ++list.first, --list.count;
    std::atomic_ref(live_).fetch_sub(1, std::memory_order_relaxed);
  }
  /// All that failed may be tried again, in their turn.
  void restart(VertexId owner) {
    if (!hasFailed(owner)) return;
    List& list = lists_[owner];
    list.next = 0;
    const auto first = pool_.begin() + static_cast<std::ptrdiff_t>(list.first);
    std::sort(first, first + list.count);
  }
  /// The best one costs `key`, more than was known. REQUIRES: best(owner).
  void raise(VertexId owner, float key) {
    assert(best(owner));
    assert(best(owner)->key <= key);
    const List& list = lists_[owner];
    std::size_t i = list.first + list.next;
    pool_[i].key = key;
    for (; i + 1 < list.first + list.count && pool_[i + 1] < pool_[i]; ++i)
      std::swap(pool_[i], pool_[i + 1]);
  }

  /// The owner is dead: all of its candidates are gone. Threads may do so at once.
  void forget(VertexId owner) {
    if (owner >= lists_.size()) return;
    std::atomic_ref(live_).fetch_sub(lists_[owner].count, std::memory_order_relaxed);
    lists_[owner] = {};
  }

  /// Closes the gaps of what is gone, when it is half of all: in place, since lists lie in the
  /// order of their owners.
  void compact() {
    if (pool_.size() < 2 * live_ + 4096) return;
    std::size_t end = 0;
    for (List& list : lists_) {
      assert(list.first >= end || list.count == 0);
      if (list.first != end)
        std::copy_n(pool_.begin() + static_cast<std::ptrdiff_t>(list.first), list.count,
                    pool_.begin() + static_cast<std::ptrdiff_t>(end));
      list.first = end;
      end += list.count;
    }
    assert(end == live_);
    pool_.resize(end);
    giveBackRoom(pool_);
  }

 private:
  // A candidate that was not legal is tried again later than its cost says: one change nearby
  // seldom removes the obstacle.
  static constexpr float kFailed = 4;
  // Owners whose candidates a thread takes over at a time.
  static constexpr std::size_t kSetAtOnce = 256;

  struct List {
    std::size_t first = 0;
    std::uint32_t next = 0, count = 0;
  };

  std::vector<Candidate> pool_;
  std::vector<List> lists_;
  std::size_t live_ = 0;
};

}  // namespace qtet
