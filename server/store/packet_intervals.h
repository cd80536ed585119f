// The intervals of the point fields' values where a packet of a `regions` log refines the mesh.
// They show whether an isosurface meets the packet. No log stores them; decoding it whole gives
// them.
#pragma once

#include <cassert>
#include <cstdint>
#include <limits>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <stop_token>
#include <vector>

#include "proto/bytes.h"
#include "proto/error.h"

namespace qtet {

class LogFile;
struct Isovalue;
struct LogIndex;
struct Manifest;

/// Both ends included; empty at first.
struct ValueInterval {
  double least = std::numeric_limits<double>::infinity(), most = -least;

  void add(const ValueInterval& other) {
    least = other.least < least ? other.least : least;
    most = other.most > most ? other.most : most;
  }
  [[nodiscard]] bool holds(double value) const { return least <= value && value <= most; }
  bool operator==(const ValueInterval&) const = default;
};

/// A table: a row a chunk, and for each field of points a column a component and, where there are
/// several, one for their length. Immutable.
class PacketIntervals {
 public:
  /// Nothing is known.
  PacketIntervals() = default;
  /// REQUIRES: as many columns as that manifest has, row by row.
  PacketIntervals(const Manifest& manifest, std::vector<ValueInterval> values);

  /// The column of an isovalue's field and component; nullopt: the log has no such field of points,
  /// or nothing is known.
  [[nodiscard]] std::optional<std::size_t> columnOf(const Manifest& manifest,
                                                    const Isovalue& isovalue) const;
  /// REQUIRES: a chunk of the table, and a column of columnOf().
  [[nodiscard]] const ValueInterval& of(std::uint32_t chunk, std::size_t column) const {
    assert(column < columns_ && chunk < values_.size() / columns_);
    return values_[chunk * columns_ + column];
  }

  /// As it is kept on disk.
  [[nodiscard]] Bytes encode() const;
  /// Nothing is known where `bytes` are not a table of that log.
  [[nodiscard]] static PacketIntervals decode(ByteView bytes, const LogIndex& index,
                                              const Manifest& manifest);
  [[nodiscard]] static std::size_t columnsOf(const Manifest& manifest);
  [[nodiscard]] std::size_t bytes() const { return values_.size() * sizeof(ValueInterval); }

 private:
  std::size_t columns_ = 0;
  std::vector<ValueInterval> values_;
};

/// A packet's interval covers the values before and after it, at every corner of every cell that it
/// changes. It contains the intervals of all packets below. So if a packet or one below it changes
/// an isosurface, the interval contains the isosurface's value. Other chunks have empty intervals.
/// Decodes the whole log; holds the finest mesh. Errors: those of decoding; io (`stop` was
/// requested; looked at after every chunk).
[[nodiscard]] Result<PacketIntervals> packetIntervals(const LogFile& log, const Manifest& manifest,
                                                      const std::stop_token& stop = {});

/// Where a log's table is kept as soon as somebody has made it. Thread-safe.
class KnownIntervals {
 public:
  /// nullptr: not yet.
  [[nodiscard]] std::shared_ptr<const PacketIntervals> now() const {
    const std::scoped_lock lock(mutex_);
    return known_;
  }
  void put(PacketIntervals table);
  /// Bytes of all tables of this process that somebody holds.
  [[nodiscard]] static std::uintmax_t bytesOfAll();

 private:
  mutable std::mutex mutex_;
  std::shared_ptr<const PacketIntervals> known_;
};

}  // namespace qtet
