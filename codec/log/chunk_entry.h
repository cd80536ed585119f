// A row of a log's chunk table (FORMAT.md, "Chunk table").
#pragma once

#include <cstdint>
#include <vector>

#include "codec/log/codec_id.h"

namespace qtet {

struct BlockEntry {
  std::uint64_t offset = 0;  ///< in the file; derived, not stored
  std::uint32_t size = 0;    ///< bytes
  std::uint32_t crc = 0;
};

/// Parts of a chunk, in file order: structure, positions, then one block a field.
inline constexpr std::uint32_t kStructurePart = 0;
inline constexpr std::uint32_t kPositionsPart = 1;
inline constexpr std::uint32_t kFirstFieldPart = 2;

/// `ChunkEntry::endSlot` of a chunk that finishes its last level.
inline constexpr std::uint32_t kLevelEnd = 0xFFFFFFFFu;

/// One row of the chunk table. Chunk 0 is the base mesh (level 0); each other one refines the mesh
/// that the chunks before it gave.
struct ChunkEntry {
  std::uint64_t offset = 0;  ///< of its first block in the file; derived, not stored
  /// The levels that its records belong to; the first follows from the row before.
  std::uint32_t firstLevel = 0;
  std::uint32_t lastLevel = 0;
  /// LastLevel is visited below this vertex slot; kLevelEnd = to its end.
  std::uint32_t endSlot = kLevelEnd;
  std::uint32_t records = 0;
  std::uint32_t newVertices = 0;
  std::uint32_t newTetrahedra = 0;
  std::uint32_t newBoundaryTriangles = 0;
  CodecId structureCodec = CodecId::kRange;
  CodecId valueCodec = CodecId::kDraco;
  std::vector<BlockEntry> blocks;  ///< 2 + fields
  /// Bytes of the blocks of later fields, which are the last ones, while their sizes are not read.
  std::uint64_t laterBytes = 0;

  [[nodiscard]] std::uint64_t size() const {
    return laterBytes + (blocks.empty() ? 0 : blocks.back().offset + blocks.back().size - offset);
  }
};

}  // namespace qtet
