// The front of a log: header, manifest and chunk table (FORMAT.md, "Header", "Chunk table"). A
// server, a viewer and a verifier read it before they touch a block. Trusts nothing: every count is
// checked against limits and against the bytes.
#pragma once

#include <cassert>
#include <cstdint>
#include <span>
#include <vector>

#include "codec/log/chunk_entry.h"
#include "codec/log/closing_block.h"
#include "codec/log/field_shape.h"
#include "proto/bytes.h"
#include "proto/error.h"

namespace qtet {

struct LogIndex {
  static constexpr std::uint32_t kHeaderBytes = 64;
  /// The format's version: this one is written, and any minor version is read.
  static constexpr std::uint16_t kVersionMajor = 4, kVersionMinor = 0;

  std::uint8_t positionBits = 0;
  std::uint64_t fileBytes = 0;
  Bytes manifest;  ///< as it stands in the file; codec/log/log_manifest.h reads it
  std::vector<FieldShape> fields;
  /// How many of the last fields stand in the part of later instants, which a viewer fetches after
  /// its first picture.
  std::uint32_t laterFields = 0;
  Bytes laterManifest;  ///< of these fields, as it stands in the part; log_manifest.h reads it
  std::uint64_t laterOffset = 0;  ///< of these bytes in the file, once they are read
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
  /// How a block is coded. REQUIRES: there is such a block.
  [[nodiscard]] CodecId blockCodec(std::uint32_t chunk, std::uint32_t part) const;
  [[nodiscard]] bool hasCellField() const;
  /// Some fields are predicted in time.
  [[nodiscard]] bool hasSeries() const;
  /// Bytes of the header's promise: how much of the file parseHead needs. Errors: truncated (under
  /// 64 bytes), bad-magic, bad-version, bad-checksum, limit-exceeded, bad-value.
  [[nodiscard]] static Result<std::uint64_t> headBytesOf(ByteView firstBytes);
  /// Reads header, manifest and table; `bytes` holds at least headBytesOf() bytes, the rest is not
  /// looked at. Later fields are not among `fields` until readLater has brought them.
  [[nodiscard]] static Result<LogIndex> parseHead(ByteView bytes);
  /// Bytes of the part of later instants, the last ones of the file; 0 once they are read.
  [[nodiscard]] std::uint32_t unreadBytes() const { return unread.bytes; }
  /// Reads this part. Errors: truncated, bad-checksum, bad-value. After one the index is of no use.
  [[nodiscard]] Status readLater(ByteView part);
  /// Both, of a whole file. The head is enough for a log without later instants.
  [[nodiscard]] static Result<LogIndex> parse(ByteView file);
  /// Parses both parts, the results of encode() and encodeLater().
  [[nodiscard]] static Result<LogIndex> parse(ByteView head, ByteView later);
  /// Header, manifest and table as they stand in the file. Ignores the values that the rows imply
  /// (offsets, first levels). REQUIRES: later instants that are read.
  [[nodiscard]] Bytes encode() const;
  /// The part of later instants; empty without any.
  [[nodiscard]] Bytes encodeLater() const;

  /// The part of later instants as the head describes it, until it is read.
  struct Unread {
    std::uint32_t bytes = 0, crc = 0, fields = 0;
  };
  Unread unread;
};

}  // namespace qtet
