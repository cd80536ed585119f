// A log's chunks as they are written: the content of the open one, and the rows of the closed ones.
// Closed blocks go to a sink.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "codec/coding/range_coder.h"
#include "codec/log/chunk_entry.h"
#include "codec/mesh/mesh.h"
#include "codec/record/values.h"
#include "proto/byte_sink.h"

namespace qtet {

class ChunkWriter {
 public:
  /// Chunk 0 is open. `fields` must outlive it. `body` takes the blocks, in file order.
  ChunkWriter(std::span<const FieldInfo> fields, CodecId valueCodec, ByteSink body);

  /// The content of the open chunk so far. These objects stay the same for every chunk.
  [[nodiscard]] RangeEncoder& structure() { return open_.structure; }
  [[nodiscard]] Values& positions() { return open_.values.front(); }
  [[nodiscard]] std::span<Values> fields() { return std::span(open_.values).subspan(1); }
  /// Counts a record of the open chunk, whose values have been written.
  void endRecord();
  /// Bytes of the open chunk's blocks, about. Only the first instant of a series counts: a viewer
  /// fetches one at a time.
  [[nodiscard]] std::uint64_t estimatedBytes() const;
  /// The same of the closed chunks, exactly.
  [[nodiscard]] std::uint64_t closedBytes() const { return closedBytes_; }

  /// close() ends the open chunk, after which the mesh has slots up to `end`. begin() opens the
  /// next one, which begins in `firstLevel`. Errors: limit-exceeded, bad-codec, the sink's.
  Status close(std::uint32_t lastLevel, std::uint32_t endSlot, const Slots& end);
  void begin(std::uint32_t firstLevel) { open_.row.firstLevel = firstLevel; }

  /// The closed chunks only.
  [[nodiscard]] std::vector<ChunkEntry>& rows() { return rows_; }

 private:
  /// Parts are numbered as blocks are, less the structure's.
  struct OpenChunk {
    ChunkEntry row;
    Slots first;
    RangeEncoder structure;
    std::vector<Values> values;
    std::vector<std::size_t> seen;  // values whose bits have been estimated
    std::uint64_t valueBits = 0;    // estimate of what they will take
  };

  Status addBlock(const Bytes& block);

  std::span<const FieldInfo> fields_;
  CodecId valueCodec_;
  ByteSink body_;
  std::vector<bool> counts_;  // by part: its bytes count in those of a chunk
  OpenChunk open_;
  // of the chunks closed since the base mesh: what the values took, and the estimates
  std::uint64_t valueBytes_ = 0, valueBits_ = 0;
  std::uint64_t closedBytes_ = 0;
  std::vector<ChunkEntry> rows_;
};

}  // namespace qtet
