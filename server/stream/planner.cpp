#include "server/stream/planner.h"

#include <cassert>
#include <utility>

#include "codec/log/log_index.h"
#include "proto/messages.h"
#include "server/stream/client_blocks.h"

namespace qtet {
namespace {

/// Collects blocks, in order, into runs.
class Runs {
 public:
  Runs(const LogIndex& index, std::uint32_t payloadBytes)
      : index_(index), payloadBytes_(payloadBytes) {}

  void add(std::uint32_t chunk, std::uint32_t part) {
    const std::uint32_t size = index_.block(chunk, part).size;
    const bool neighbour = !out_.empty() && out_.back().chunk == chunk &&
                           out_.back().firstPart + out_.back().parts == part;
    if (neighbour && bytes_ + size <= payloadBytes_) {
      ++out_.back().parts;
      bytes_ += size;
      return;
    }
    out_.push_back({chunk, static_cast<std::uint16_t>(part), 1});
    bytes_ = size;
  }

  [[nodiscard]] std::vector<BlockRun> take() { return std::move(out_); }

 private:
  const LogIndex& index_;
  std::uint32_t payloadBytes_;
  std::uint64_t bytes_ = 0;  // in the last run
  std::vector<BlockRun> out_;
};

}  // namespace

std::vector<BlockRun> planStream(const LogIndex& index, const ClientBlocks& blocks,
                                 std::uint32_t lastChunk, std::uint32_t payloadBytes) {
  assert(lastChunk < index.chunks.size());
  Runs runs(index, payloadBytes);
  for (std::size_t turn = 0; turn < blocks.turns().size(); ++turn) {
    const std::vector<std::size_t> columns = blocks.columnsOf(turn);
    for (std::uint32_t chunk = 0; chunk <= lastChunk; ++chunk)
      for (const std::size_t column : columns)
        if (!blocks.has(chunk, column)) runs.add(chunk, blocks.partOf(column));
  }
  return runs.take();
}

FileSlice sliceOf(const LogIndex& index, const BlockRun& run) {
  if (run.firstPart == FrameHeader::kHead)
    return {0, static_cast<std::uint32_t>(index.headBytes())};
  const BlockEntry& first = index.block(run.chunk, run.firstPart);
  const BlockEntry& last = index.block(run.chunk, std::uint32_t{run.firstPart} + run.parts - 1);
  return {first.offset, static_cast<std::uint32_t>(last.offset + last.size - first.offset)};
}

}  // namespace qtet
