// The entries of a level's queue: which are cheap enough for it, cheapest first.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "codec/mesh/mesh.h"

namespace qtet {

struct QueueEntry {
  float key = 0;
  VertexId owner = 0;
  /// The heap keeps the largest on top; equal keys in order of the owner, so that the outcome is
  /// one and the same everywhere.
  bool operator<(const QueueEntry& other) const {
    return key != other.key ? key > other.key : owner > other.owner;
  }
};

class EntrySorter {
 public:
  /// Leaves the entries whose key does not pass this quantile of all keys, cheapest first, equal
  /// keys in order of the owner. Returns the quantile. Digit by digit: a comparison of two keys is
  /// a branch that no processor foresees.
  /// REQUIRES: entries, each owner larger than the one before; no key is NaN; 0 <= quantile <= 1.
  float keepCheapest(std::vector<QueueEntry>& entries, double quantile);

 private:
  void sort(std::vector<QueueEntry>& entries);

  std::vector<std::uint32_t> counts_, ranks_;
  std::vector<QueueEntry> room_;
};

}  // namespace qtet
