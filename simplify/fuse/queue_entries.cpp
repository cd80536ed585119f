#include "simplify/fuse/queue_entries.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cstddef>
#include <utility>

namespace qtet {
namespace {

constexpr int kDigitBits = 11;
constexpr std::uint32_t kDigits = 1u << kDigitBits;

// Ascends with the key; both zeros are one.
std::uint32_t rankOf(const QueueEntry& entry) {
  const auto bits = std::bit_cast<std::uint32_t>(entry.key + 0.0f);
  return bits ^ ((0u - (bits >> 31)) | 0x80000000u);
}

}  // namespace

float EntrySorter::keepCheapest(std::vector<QueueEntry>& entries, double quantile) {
  assert(!entries.empty() && quantile >= 0 && quantile <= 1);
  const auto at = static_cast<std::size_t>(quantile * static_cast<double>(entries.size() - 1));
  counts_.assign(kDigits, 0);
  for (const QueueEntry& e : entries) ++counts_[rankOf(e) >> (32 - kDigitBits)];
  std::uint32_t digit = 0;
  std::size_t before = 0;
  while (before + counts_[digit] <= at) before += counts_[digit++];
  ranks_.clear();
  for (const QueueEntry& e : entries)
    if (const std::uint32_t rank = rankOf(e); rank >> (32 - kDigitBits) == digit)
      ranks_.push_back(rank);
  assert(at >= before && at - before < ranks_.size());
  const auto nth = ranks_.begin() + static_cast<std::ptrdiff_t>(at - before);
  std::nth_element(ranks_.begin(), nth, ranks_.end());
  const std::uint32_t limit = *nth;
  std::size_t kept = 0;
  float key = 0;
  for (const QueueEntry& e : entries) {
    const std::uint32_t rank = rankOf(e);
    if (rank == limit) key = e.key;
    entries[kept] = e;
    kept += rank <= limit;
  }
  assert(kept > at);
  entries.resize(kept);
  sort(entries);
  return key;
}

// Sorts from the last digit to the first, each time in the order of the one before.
void EntrySorter::sort(std::vector<QueueEntry>& entries) {
  room_.resize(entries.size());
  for (int shift = 0; shift < 32; shift += kDigitBits) {
    const auto digitOf = [shift](const QueueEntry& e) {
      return rankOf(e) >> shift & (kDigits - 1);
    };
    counts_.assign(kDigits, 0);
    for (const QueueEntry& e : entries) ++counts_[digitOf(e)];
    std::uint32_t end = 0;
    for (std::uint32_t& count : counts_) end += std::exchange(count, end);
    for (const QueueEntry& e : entries) room_[counts_[digitOf(e)]++] = e;
    entries.swap(room_);
  }
}

}  // namespace qtet
