// Records that are brought together by a key although they do not all fit in memory: equal keys are
// in one bucket.
#pragma once

#include <array>
#include <cassert>
#include <cstdint>
#include <cstring>
#include <type_traits>
#include <utility>
#include <vector>

#include "simplify/mesh/split_mix64.h"
#include "simplify/pieces/piece_spool.h"

namespace qtet {

/// `Record`: without padding, ordered by <=>.
template <class Record>
class RecordBuckets {
  static_assert(std::has_unique_object_representations_v<Record>);

 public:
  /// Errors: those of `make`.
  [[nodiscard]] static Result<RecordBuckets> made(const MakeSpool& make) {
    Result<PieceSpool> spool = PieceSpool::made(make);
    if (!spool) return std::unexpected(spool.error());
    return RecordBuckets(std::move(*spool));
  }

  /// Records of equal keys have equal hashes. Errors: io.
  Status add(std::uint64_t hash, const Record& record) {
    const std::size_t bucket = mixed(hash) % kBuckets;
    waiting_[bucket].push_back(record);
    return waiting_[bucket].size() < kBatch ? Status{} : flush(bucket);
  }
  /// Gives each bucket's records, ascending, and forgets them. Errors: io, those of `take`.
  template <class Take>
  Status forEach(const Take& take) {
    for (std::size_t bucket = 0; bucket < kBuckets; ++bucket) {
      std::vector<Record> records = std::move(waiting_[bucket]);
      for (const std::size_t piece : std::exchange(pieces_[bucket], {})) {
        const Result<Bytes> bytes = spool_.get(piece);
        if (!bytes) return std::unexpected(bytes.error());
        const std::size_t before = records.size(), count = bytes->size() / sizeof(Record);
        records.resize(before + count);
        std::memcpy(records.data() + before, bytes->data(), count * sizeof(Record));
      }
      std::ranges::sort(records);
      if (Status s = take(std::as_const(records)); !s) return s;
    }
    return {};
  }

 private:
  /// A bucket is sorted in memory: with a billion faces in them it takes 200 MB.
  static constexpr std::size_t kBuckets = 256;
  static constexpr std::size_t kBatch = 1024;  ///< records that wait in memory, a bucket

  explicit RecordBuckets(PieceSpool spool) : spool_(std::move(spool)) {}

  Status flush(std::size_t bucket) {
    std::vector<Record>& records = waiting_[bucket];
    Bytes bytes(records.size() * sizeof(Record));
    std::memcpy(bytes.data(), records.data(), bytes.size());
    records.clear();
    pieces_[bucket].push_back(spool_.count());
    return spool_.add(bytes);
  }

  PieceSpool spool_;
  std::array<std::vector<Record>, kBuckets> waiting_;
  std::array<std::vector<std::size_t>, kBuckets> pieces_;  // in the spool
};

}  // namespace qtet
