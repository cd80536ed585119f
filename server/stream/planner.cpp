#include "server/stream/planner.h"

#include <cassert>

#include "codec/log/log_index.h"
#include "proto/messages.h"
#include "server/stream/client_blocks.h"

namespace qtet {

StreamPlan::StreamPlan(const LogIndex& index, std::uint32_t lastChunk, std::uint32_t payloadBytes)
    : index_(&index), lastChunk_(lastChunk), payloadBytes_(payloadBytes) {
  assert(lastChunk < index.chunks.size());
}

bool StreamPlan::seek(const ClientBlocks& blocks) {
  for (; turn_ < blocks.turns().size(); ++turn_, chunk_ = 0, columns_.clear()) {
    if (columns_.empty()) columns_ = blocks.columnsOf(turn_);
    for (; chunk_ <= lastChunk_; ++chunk_, column_ = 0)
      for (; column_ < columns_.size(); ++column_)
        if (!blocks.has(chunk_, columns_[column_])) return true;
  }
  return false;
}

std::optional<BlockRun> StreamPlan::next(const ClientBlocks& blocks) {
  assert(index_ != nullptr);
  if (!seek(blocks)) return std::nullopt;
  const auto partHere = [&] { return blocks.partOf(columns_[column_]); };
  assert(chunk_ <= lastChunk_ && column_ < columns_.size());
  BlockRun out{chunk_, static_cast<std::uint16_t>(partHere()), 1};
  std::uint64_t bytes = index_->block(chunk_, partHere()).size;
  for (++column_; seek(blocks); ++column_, ++out.parts) {
    bytes += index_->block(chunk_, partHere()).size;
    if (chunk_ != out.chunk || partHere() != std::uint32_t{out.firstPart} + out.parts ||
        bytes > payloadBytes_)
      break;
  }
  return out;
}

std::uint64_t lackingBytes(const LogIndex& index, const ClientBlocks& blocks,
                           std::uint32_t lastChunk) {
  assert(lastChunk < index.chunks.size());
  std::uint64_t out = 0;
  for (std::uint32_t chunk = 0; chunk <= lastChunk; ++chunk)
    for (std::size_t column = 0; column < blocks.columns(); ++column)
      if (!blocks.has(chunk, column)) out += index.block(chunk, blocks.partOf(column)).size;
  return out;
}

FileSlice sliceOf(const LogIndex& index, const BlockRun& run) {
  if (run.firstPart == FrameHeader::kHead)
    return {0, static_cast<std::uint32_t>(index.headBytes())};
  assert(run.parts > 0 && std::uint32_t{run.firstPart} + run.parts <= index.parts());
  const BlockEntry& first = index.block(run.chunk, run.firstPart);
  const BlockEntry& last = index.block(run.chunk, std::uint32_t{run.firstPart} + run.parts - 1);
  assert(first.offset <= last.offset + last.size && last.offset + last.size <= index.fileBytes);
  return {first.offset, static_cast<std::uint32_t>(last.offset + last.size - first.offset)};
}

}  // namespace qtet
