#include "codec/log/chunk_table.h"

#include <algorithm>
#include <cassert>
#include <utility>

#include "proto/limits.h"

namespace qtet {
namespace {

/// The level that a row begins with: the one that the chunk before it left, or the next one if that
/// was complete.
std::uint32_t firstLevelOf(std::span<const ChunkEntry> chunks, std::size_t chunk) {
  if (chunk == 0) return 0;
  const ChunkEntry& before = chunks[chunk - 1];
  return before.lastLevel + (before.endSlot == kLevelEnd);
}

/// Bytes of many blocks, as two varints: the high 32 bits and the low ones.
std::uint64_t readLong(ByteReader& r) {
  const std::uint64_t high = r.readVarint();
  return high << 32 | r.readVarint();
}
void writeLong(ByteWriter& w, std::uint64_t number) {
  w.writeVarint(static_cast<std::uint32_t>(number >> 32));
  w.writeVarint(static_cast<std::uint32_t>(number));
}

/// The sizes of blocks that lie back to back from `offset`. Returns where they end.
std::uint64_t readSizes(ByteReader& r, std::span<BlockEntry> blocks, std::uint64_t offset) {
  for (BlockEntry& b : blocks) {
    b.offset = offset;
    b.size = r.readVarint();
    offset += b.size;
  }
  return offset;
}
void readChecksums(ByteReader& r, std::span<BlockEntry> blocks) {
  for (BlockEntry& b : blocks) b.crc = r.read<std::uint32_t>();
}
void writeSizes(ByteWriter& w, std::span<const BlockEntry> blocks) {
  for (const BlockEntry& b : blocks) w.writeVarint(b.size);
}
void writeChecksums(ByteWriter& w, std::span<const BlockEntry> blocks) {
  for (const BlockEntry& b : blocks) w.write(b.crc);
}

std::uint64_t bytesOf(std::span<const BlockEntry> blocks) {
  std::uint64_t sum = 0;
  for (const BlockEntry& b : blocks) sum += b.size;
  return sum;
}

void readLevels(ByteReader& r, std::span<const ChunkEntry> before, ChunkEntry& e) {
  const std::uint64_t first = firstLevelOf(before, before.size());
  const std::uint64_t last = first + r.readVarint();
  if (last > kMaxLevels)
    return r.fail(ErrorCode::kLimitExceeded,
                  "more than 4,096 levels; fetch or build the log again");
  e.firstLevel = static_cast<std::uint32_t>(first);
  e.lastLevel = static_cast<std::uint32_t>(last);
  e.endSlot = r.readVarint() - 1;  // 0 stands for kLevelEnd
}

}  // namespace

std::vector<ChunkEntry> readChunkRows(ByteReader& r, std::uint32_t chunks, RowParts parts,
                                      std::uint64_t offset) {
  assert(r.failed() || chunks * minRowBytes(parts) <= r.remaining());
  std::vector<ChunkEntry> out;
  out.reserve(chunks);
  while (out.size() < chunks && !r.failed()) {
    ChunkEntry e;
    e.offset = offset;
    readLevels(r, out, e);
    for (std::uint32_t* value :
         {&e.records, &e.newVertices, &e.newTetrahedra, &e.newBoundaryTriangles})
      *value = r.readVarint();
    const auto codecs = r.read<std::uint8_t>();
    e.structureCodec = static_cast<CodecId>(codecs & 15u);
    e.valueCodec = static_cast<CodecId>(codecs >> 4);
    e.blocks.resize(parts.count);
    offset = readSizes(r, e.blocks, offset);
    if (parts.endsWithLater) offset += e.laterBytes = readLong(r);
    readChecksums(r, e.blocks);
    out.push_back(std::move(e));
  }
  return out;
}

void writeChunkRows(ByteWriter& w, std::span<const ChunkEntry> chunks, RowParts parts) {
  for (std::size_t chunk = 0; chunk < chunks.size(); ++chunk) {
    const ChunkEntry& e = chunks[chunk];
    w.writeVarint(e.lastLevel - firstLevelOf(chunks, chunk));
    for (const std::uint32_t value :
         {e.endSlot + 1, e.records, e.newVertices, e.newTetrahedra, e.newBoundaryTriangles})
      w.writeVarint(value);
    w.write(static_cast<std::uint8_t>(static_cast<unsigned>(e.structureCodec) |
                                      static_cast<unsigned>(e.valueCodec) << 4));
    const std::size_t count = std::min<std::size_t>(parts.count, e.blocks.size());
    const std::span known = std::span(e.blocks).first(count);
    writeSizes(w, known);
    if (parts.endsWithLater) writeLong(w, bytesOf(std::span(e.blocks).subspan(count)));
    writeChecksums(w, known);
  }
}

void readLaterBlocks(ByteReader& r, std::uint32_t count, std::span<ChunkEntry> chunks) {
  assert(r.failed() || std::uint64_t{5} * count * chunks.size() <= r.remaining());
  for (ChunkEntry& e : chunks) {
    const std::uint64_t begin = e.offset + e.size() - e.laterBytes;
    const std::size_t first = e.blocks.size();
    e.blocks.resize(first + count);
    const std::span later = std::span(e.blocks).subspan(first);
    const std::uint64_t end = readSizes(r, later, begin);
    readChecksums(r, later);
    if (end - begin != e.laterBytes && !r.failed())
      r.fail(ErrorCode::kBadValue,
             "the blocks of later instants have other sizes than the chunk table says; fetch or "
             "build the log again");
    e.laterBytes = 0;
  }
}

void writeLaterBlocks(ByteWriter& w, std::uint32_t count, std::span<const ChunkEntry> chunks) {
  for (const ChunkEntry& e : chunks) {
    assert(count <= e.blocks.size());
    const std::span later = std::span(e.blocks).last(count);
    writeSizes(w, later);
    writeChecksums(w, later);
  }
}

std::vector<ClosingBlock> readClosingRows(ByteReader& r, std::uint32_t count,
                                          std::uint64_t offset) {
  std::vector<ClosingBlock> out;
  if (r.failed()) return out;
  out.reserve(count);
  while (out.size() < count && !r.failed()) {
    ClosingBlock c;
    c.kind = static_cast<ClosingKind>(r.readVarint());
    c.field = r.readVarint();
    c.block.offset = offset;
    c.block.size = r.readVarint();
    c.block.crc = r.read<std::uint32_t>();
    offset += c.block.size;
    out.push_back(c);
  }
  return out;
}

void writeClosingRows(ByteWriter& w, std::span<const ClosingBlock> blocks) {
  for (const ClosingBlock& c : blocks) {
    for (const std::uint32_t value : {static_cast<std::uint32_t>(c.kind), c.field, c.block.size})
      w.writeVarint(value);
    w.write(c.block.crc);
  }
}

}  // namespace qtet
