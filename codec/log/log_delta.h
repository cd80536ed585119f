// A log as pieces of another log and bytes of its own. This is what travels to a server that has
// most of the log already (PROTOCOL.md, "Deltas").
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "proto/bytes.h"
#include "proto/error.h"

namespace qtet {

struct LogIndex;

/// The bytes of a log from byte `first` on, as a delta to the log that `old` describes; `index` is
/// the log's own. A block is taken from the old log if its size and its CRC-32C are the same there.
/// That is no proof, so the receiver must compare the digest of the whole. nullopt: it would take
/// more than `most` bytes. REQUIRES: later instants of both that are read.
[[nodiscard]] std::optional<Bytes> makeDelta(const LogIndex& old, const LogIndex& index,
                                             ByteView log, std::uint64_t first, std::uint64_t most);

/// Bytes of a delta for each byte that it gives: an instruction's three u64, and the byte itself.
inline constexpr std::uint64_t kMaxDeltaBytesAByte = 25;

/// Reads a delta that arrives piece by piece, and gives the new log's bytes piece by piece.
class DeltaReader {
 public:
  /// The three integers of an instruction, before its own bytes.
  static constexpr std::size_t kHeadBytes = kMaxDeltaBytesAByte - 1;

  /// `base` is the old log, which must outlive the reader. The delta may give `most` bytes.
  DeltaReader(ByteView base, std::uint64_t most) : base_(base), left_(most) {}

  /// Takes the next bytes of the delta, which must stay until next() has used them up. REQUIRES:
  /// needsBytes().
  void feed(ByteView delta);
  /// The next bytes of the new log, at most `most` of them; none: the reader needs bytes. Errors:
  /// bad-value (a piece beyond the old log's end or before the last one, an instruction without a
  /// byte, more bytes than promised). After an error the reader is of no use.
  [[nodiscard]] Result<ByteView> next(std::size_t most);
  /// Everything that was fed is used up, and the bytes that it names are given.
  [[nodiscard]] bool needsBytes() const { return fed_.empty() && copyBytes_ == 0; }
  /// The delta may end here.
  [[nodiscard]] bool isWhole() const {
    return needsBytes() && headBytes_ == 0 && literalBytes_ == 0;
  }

 private:
  [[nodiscard]] Status readHead();

  ByteView base_, fed_;
  std::uint64_t left_;  ///< bytes that it may still give
  std::array<std::uint8_t, kHeadBytes> head_{};
  std::size_t headBytes_ = 0;                       ///< of an instruction that is not whole
  std::uint64_t copyFrom_ = 0;                      ///< in the old log; never goes back
  std::uint64_t copyBytes_ = 0, literalBytes_ = 0;  ///< to be given
};

}  // namespace qtet
