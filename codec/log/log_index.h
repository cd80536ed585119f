// The front of a log: header, manifest and chunk table (FORMAT.md, "Header", "Chunk table"). A
// server, a viewer and a verifier read it before they touch a block. Trusts nothing: every count is
// checked against limits and against the bytes.
#pragma once

#include <cassert>
#include <cstdint>
#include <span>
#include <vector>

#include "codec/log/codec_id.h"
#include "codec/mesh/time_prediction.h"
#include "proto/bytes.h"
#include "proto/error.h"

namespace qtet {

/// The kind of element that a field's values belong to.
enum class Association : std::uint8_t { kPoint = 0, kCell = 1 };

/// The part of a field's description that decoding needs; the manifest has the rest.
struct FieldShape {
  std::uint32_t components = 1;  ///< 1..kMaxFieldComponents
  Association association = Association::kPoint;
  bool hasMissing = false;  ///< values may be missing: Values::codeOrMissing
  TimePrediction prediction{};
};

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

  [[nodiscard]] std::uint64_t size() const {
    return blocks.empty() ? 0 : blocks.back().offset + blocks.back().size - offset;
  }
};

/// The content of a closing block (FORMAT.md, "Closing blocks").
enum class ClosingKind : std::uint32_t {
  kPointOrder = 1,      ///< the input's numbering of points
  kCellOrder = 2,       ///< the input's numbering of cells and of their vertices; needs the points'
  kExactPositions = 3,  ///< the input's own coordinates
  kExactField = 4,      ///< the input's own values of one field
  kOriginalCells = 5,   ///< the file's cell that each was split from; needs the cells' order
};

/// A block behind the last chunk. No level needs it: who wants the input itself and not only its
/// mesh on the lattice fetches it.
struct ClosingBlock {
  /// Or one that this build does not know, to be left alone.
  ClosingKind kind = ClosingKind::kPointOrder;
  std::uint32_t field = 0;  ///< of kExactField; else 0
  BlockEntry block;
};

struct LogIndex {
  static constexpr std::uint32_t kHeaderBytes = 64;
  /// Without fields that are predicted in time, and with some.
  static constexpr std::uint16_t kVersionMajor = 2, kVersionOfSeries = 3;
  /// The minor version of a log with original cells; one without is of 0.
  static constexpr std::uint16_t kMinorOfOriginalCells = 1;
  /// The minor version of a log whose manifest has a focus or an opening.
  static constexpr std::uint16_t kMinorOfFirstView = 2;
  /// The minor version of a log that has known errors, since not all levels need have one.
  static constexpr std::uint16_t kMinorOfSomeErrors = 3;

  std::uint8_t positionBits = 0;
  std::uint64_t fileBytes = 0;
  Bytes manifest;  ///< as it stands in the file; codec/log/log_manifest.h reads it
  /// The least minor version that has what the manifest holds; when read, the header's.
  std::uint16_t manifestMinor = 0;
  std::vector<FieldShape> fields;
  std::vector<ChunkEntry> chunks;
  std::vector<ClosingBlock> closing;  ///< in file order

  /// The closing block of that kind (and field), or nullptr.
  [[nodiscard]] const ClosingBlock* closingBlock(ClosingKind kind, std::uint32_t field = 0) const;
  /// Bytes of header + manifest + table: where the first block starts.
  [[nodiscard]] std::uint64_t headBytes() const;
  [[nodiscard]] const BlockEntry& block(std::uint32_t chunk, std::uint32_t part) const {
    return chunks[chunk].blocks[part];
  }
  [[nodiscard]] std::uint32_t parts() const {
    return kFirstFieldPart + static_cast<std::uint32_t>(fields.size());
  }
  /// Tuples in a value block of a chunk, and integers in each of them. REQUIRES: a part that is not
  /// the structure.
  [[nodiscard]] std::uint32_t tuples(std::uint32_t chunk, std::uint32_t part) const;
  [[nodiscard]] std::uint32_t components(std::uint32_t part) const {
    assert(part != kStructurePart && part < parts());
    return part == kPositionsPart ? 3 : fields[part - kFirstFieldPart].components;
  }
  [[nodiscard]] bool hasCellField() const;
  /// Some fields are predicted in time.
  [[nodiscard]] bool hasSeries() const;
  /// These fields and those that they are predicted from, ascending, each once. REQUIRES: fields of
  /// the log.
  [[nodiscard]] std::vector<std::uint32_t> withParents(std::span<const std::uint32_t> wanted) const;
  /// Bytes of the header's promise: how much of the file `parse` needs. Errors: truncated (under 64
  /// bytes), bad-magic, bad-version, bad-checksum, limit-exceeded, bad-value.
  [[nodiscard]] static Result<std::uint64_t> headBytesOf(ByteView firstBytes);
  /// Reads the front of a log; `bytes` holds at least headBytesOf() bytes, the rest is not looked
  /// at.
  [[nodiscard]] static Result<LogIndex> parse(ByteView bytes);
  /// Header, manifest and table as they stand in the file. Ignores the values that the rows imply
  /// (offsets, first levels).
  [[nodiscard]] Bytes encode() const;
};

}  // namespace qtet
