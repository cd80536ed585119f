// The queue of a level: its vertices by what their best candidate costs, and those that come back.
#pragma once

#include <algorithm>
#include <boost/heap/d_ary_heap.hpp>
#include <cassert>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "simplify/fuse/queue_entries.h"

namespace qtet {

class LevelQueue {
 public:
  /// The next level's entries, to be overwritten, in order of their owners; then begin.
  [[nodiscard]] std::vector<QueueEntry>& refill() { return entries_; }
  /// Keeps the entries up to this quantile of their keys, where the level ends. REQUIRES: as
  /// EntrySorter::keepCheapest.
  void begin(double quantile) {
    back_.clear();
    next_ = 0;
    limit_ = sorter_.keepCheapest(entries_, quantile);
  }

  /// Cheapest first.
  [[nodiscard]] std::span<const QueueEntry> entries() const { return entries_; }
  /// The key where the level ends.
  [[nodiscard]] float limit() const { return limit_; }
  /// The key of the next entry; infinity when there is none.
  [[nodiscard]] float nextKey() const {
    const float key =
        next_ < entries_.size() ? entries_[next_].key : std::numeric_limits<float>::infinity();
    return back_.empty() ? key : std::min(key, back_.top().key);
  }
  struct Next {
    VertexId owner;
    std::size_t entry;  ///< kBack: it came back
  };
  static constexpr std::size_t kBack = ~std::size_t{0};
  /// REQUIRES: nextKey() is not infinity.
  Next pop() {
    assert(next_ < entries_.size() || !back_.empty());
    if (next_ < entries_.size() && (back_.empty() || back_.top() < entries_[next_])) {
      const std::size_t entry = next_++;
      return {entries_[entry].owner, entry};
    }
    const VertexId owner = back_.top().owner;
    back_.pop();
    return {owner, kBack};
  }
  /// It comes back at this key.
  void push(const QueueEntry& entry) {
    assert(entry.key <= limit_);
    back_.push(entry);
  }

 private:
  std::vector<QueueEntry> entries_;
  EntrySorter sorter_;
  std::size_t next_ = 0;  // into entries_
  boost::heap::d_ary_heap<QueueEntry, boost::heap::arity<4>> back_;
  float limit_ = 0;
};

}  // namespace qtet
