// The geometry of a log's chunks as it is written: the content of the open one, and the rows and
// blocks of the closed ones. Fields come later (field_blocks.h).
#pragma once

#include <cstdint>
#include <vector>

#include "codec/coding/range_coder.h"
#include "codec/log/chunk_entry.h"
#include "codec/mesh/mesh.h"
#include "codec/record/values.h"
#include "proto/bytes.h"
#include "proto/error.h"

namespace qtet {

class ChunkWriter {
 public:
  /// Chunk 0 is open.
  explicit ChunkWriter(CodecId valueCodec) : valueCodec_(valueCodec) {}

  /// The content of the open chunk so far. These objects stay the same for every chunk.
  [[nodiscard]] RangeEncoder& structure() { return structure_; }
  [[nodiscard]] Values& positions() { return positions_; }
  /// Counts a record of the open chunk, whose positions have been written. Its fields' values will
  /// take about `fieldBits`.
  void endRecord(std::uint64_t fieldBits);
  /// Bytes of the open chunk's blocks, about.
  [[nodiscard]] std::uint64_t estimatedBytes() const;
  /// The same of the closed chunks; exact but for their fields.
  [[nodiscard]] std::uint64_t closedBytes() const { return closedBytes_; }

  /// close() ends the open chunk, after which the mesh has slots up to `end`. begin() opens the
  /// next one, which begins in `firstLevel`. Errors: limit-exceeded, bad-codec.
  Status close(std::uint32_t lastLevel, std::uint32_t endSlot, const Slots& end);
  void begin(std::uint32_t firstLevel) { row_.firstLevel = firstLevel; }
  /// Adds a block of a closed chunk. Errors: limit-exceeded.
  static Status addBlock(ChunkEntry& row, ByteView block);

  /// The closed chunks only: their rows, and the blocks of their structure and positions.
  [[nodiscard]] std::vector<ChunkEntry>& rows() { return rows_; }
  [[nodiscard]] const std::vector<Bytes>& geometry() const { return geometry_; }

 private:
  const CodecId valueCodec_;
  // of the open chunk
  ChunkEntry row_;
  Slots first_;
  RangeEncoder structure_;
  Values positions_;
  std::size_t seen_ = 0;            // positions whose bits have been estimated
  std::uint64_t positionBits_ = 0;  // estimate of what they will take
  std::uint64_t fieldBits_ = 0;
  // of the chunks closed since the base mesh: what positions took, and the estimates
  std::uint64_t closedPositionBytes_ = 0, closedPositionBits_ = 0;
  std::uint64_t closedBytes_ = 0;
  std::vector<ChunkEntry> rows_;
  std::vector<Bytes> geometry_;
};

}  // namespace qtet
