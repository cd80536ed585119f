#include "codec/log/chunk_table.h"

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

std::vector<ChunkEntry> readChunkRows(ByteReader& r, std::uint32_t chunks, std::uint32_t parts,
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
    e.blocks.resize(parts);
    for (BlockEntry& b : e.blocks) {
      b.offset = offset;
      b.size = r.readVarint();
      offset += b.size;
    }
    for (BlockEntry& b : e.blocks) b.crc = r.read<std::uint32_t>();
    out.push_back(std::move(e));
  }
  return out;
}

void writeChunkRows(ByteWriter& w, std::span<const ChunkEntry> chunks) {
  for (std::size_t chunk = 0; chunk < chunks.size(); ++chunk) {
    const ChunkEntry& e = chunks[chunk];
    w.writeVarint(e.lastLevel - firstLevelOf(chunks, chunk));
    for (const std::uint32_t value :
         {e.endSlot + 1, e.records, e.newVertices, e.newTetrahedra, e.newBoundaryTriangles})
      w.writeVarint(value);
    w.write(static_cast<std::uint8_t>(static_cast<unsigned>(e.structureCodec) |
                                      static_cast<unsigned>(e.valueCodec) << 4));
    for (const BlockEntry& b : e.blocks) w.writeVarint(b.size);
    for (const BlockEntry& b : e.blocks) w.write(b.crc);
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
