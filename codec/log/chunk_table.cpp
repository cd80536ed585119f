#include "codec/log/chunk_table.h"

#include <bit>
#include <cassert>

#include "proto/limits.h"

namespace qtet {
namespace {

/// The level that a row begins with: the one that the chunk before it left, or the next one if that
/// was complete. Packets of one band begin alike.
std::uint32_t firstLevelOf(const LogIndex& index, std::size_t chunk, std::uint32_t node) {
  if (chunk == 0) return 0;
  const ChunkEntry& before = index.chunks[chunk - 1];
  if (node != 0 && !std::has_single_bit(node)) return before.firstLevel;
  return before.lastLevel + (before.endSlot == kLevelEnd);
}

void readLevels(ByteReader& r, const LogIndex& index, ChunkEntry& e) {
  const std::uint64_t first = firstLevelOf(index, index.chunks.size(), e.node);
  const std::uint64_t last = first + r.readVarint();
  if (last > kMaxLevels)
    return r.fail(ErrorCode::kLimitExceeded,
                  "more than 4,096 levels; fetch or build the log again");
  e.firstLevel = static_cast<std::uint32_t>(first);
  e.lastLevel = static_cast<std::uint32_t>(last);
  e.endSlot = r.readVarint() - 1;  // 0 stands for kLevelEnd
}

/// How far back the chunk is that a row depends on. Nodes are numbered in the order of the rows;
/// the index's check() enforces this.
std::uint32_t stepsBack(const LogIndex& index, std::size_t chunk, std::uint32_t node) {
  if (node == 0) return 1;
  const std::uint32_t toParent = node - node / 2;
  if (toParent <= chunk && index.chunks[chunk - toParent].node == node / 2) return toParent;
  return node - std::bit_floor(node) + 1;  // of the first band: the head's last chunk
}

// A chunk depends on one other: the one before it, or a packet on its parent's.
void deriveDependency(ByteReader& r, LogIndex& index, ChunkEntry& e) {
  const auto chunk = static_cast<std::uint32_t>(index.chunks.size());
  e.firstDependency = static_cast<std::uint32_t>(index.dependencies.size());
  e.dependencyCount = chunk > 0;
  if (chunk == 0) return;
  const std::uint32_t back = stepsBack(index, chunk, e.node);
  if (back > chunk)
    return r.fail(ErrorCode::kBadValue,
                  "a packet without its parent's before it; fetch or build the log again");
  index.dependencies.push_back(chunk - back);
}

void readNode(ByteReader& r, ChunkEntry& e) {
  e.node = r.readVarint();
  if (e.node == 0) return;
  for (std::uint8_t& x : e.box.least) x = r.read<std::uint8_t>();
  for (std::uint8_t& x : e.box.most) x = r.read<std::uint8_t>();
}

void writeNode(ByteWriter& w, const ChunkEntry& e) {
  w.writeVarint(e.node);
  if (e.node == 0) return;
  for (const std::uint8_t x : e.box.least) w.write(x);
  for (const std::uint8_t x : e.box.most) w.write(x);
}

}  // namespace

void readChunkRows(ByteReader& r, LogIndex& index, std::uint32_t chunks, std::uint64_t offset) {
  assert(r.failed() || chunks * minRowBytes(index.parts()) <= r.remaining());
  index.chunks.reserve(chunks);
  while (index.chunks.size() < chunks && !r.failed()) {
    ChunkEntry e;
    e.offset = offset;
    if (index.layout == Layout::kRegions) readNode(r, e);
    readLevels(r, index, e);
    for (std::uint32_t* value :
         {&e.records, &e.newVertices, &e.newTetrahedra, &e.newBoundaryTriangles})
      *value = r.readVarint();
    const auto codecs = r.read<std::uint8_t>();
    e.structureCodec = static_cast<CodecId>(codecs & 15u);
    e.valueCodec = static_cast<CodecId>(codecs >> 4);
    deriveDependency(r, index, e);
    e.blocks.resize(index.parts());
    for (BlockEntry& b : e.blocks) {
      b.offset = offset;
      b.size = r.readVarint();
      offset += b.size;
    }
    for (BlockEntry& b : e.blocks) b.crc = r.read<std::uint32_t>();
    index.chunks.push_back(std::move(e));
  }
}

void writeChunkRows(ByteWriter& w, const LogIndex& index) {
  for (std::size_t chunk = 0; chunk < index.chunks.size(); ++chunk) {
    const ChunkEntry& e = index.chunks[chunk];
    if (index.layout == Layout::kRegions) writeNode(w, e);
    w.writeVarint(e.lastLevel - firstLevelOf(index, chunk, e.node));
    for (const std::uint32_t value :
         {e.endSlot + 1, e.records, e.newVertices, e.newTetrahedra, e.newBoundaryTriangles})
      w.writeVarint(value);
    w.write(static_cast<std::uint8_t>(static_cast<unsigned>(e.structureCodec) |
                                      static_cast<unsigned>(e.valueCodec) << 4));
    for (const BlockEntry& b : e.blocks) w.writeVarint(b.size);
    for (const BlockEntry& b : e.blocks) w.write(b.crc);
  }
}

void readClosingRows(ByteReader& r, LogIndex& index, std::uint32_t count) {
  if (r.failed()) return;
  assert(!index.chunks.empty());
  std::uint64_t offset = index.chunks.back().offset + index.chunks.back().size();
  index.closing.reserve(count);
  while (index.closing.size() < count && !r.failed()) {
    ClosingBlock c;
    c.kind = static_cast<ClosingKind>(r.readVarint());
    c.field = r.readVarint();
    c.block.offset = offset;
    c.block.size = r.readVarint();
    c.block.crc = r.read<std::uint32_t>();
    offset += c.block.size;
    index.closing.push_back(c);
  }
}

void writeClosingRows(ByteWriter& w, const LogIndex& index) {
  for (const ClosingBlock& c : index.closing) {
    for (const std::uint32_t value : {static_cast<std::uint32_t>(c.kind), c.field, c.block.size})
      w.writeVarint(value);
    w.write(c.block.crc);
  }
}

}  // namespace qtet
