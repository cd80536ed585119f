#include "codec/log/log_index.h"

#include <algorithm>
#include <array>
#include <cassert>

#include "codec/log/chunk_table.h"
#include "proto/crc32c.h"
#include "proto/limits.h"

namespace qtet {
namespace {

// As PNG's: the high bit finds seven-bit transfers, CR LF and LF find text-mode copies, 0x1A stops
// DOS type.
constexpr std::array<std::uint8_t, 8> kMagic{0x89, 'Q', 'T', 'E', 'T', '\r', '\n', 0x1A};

// Beside a field's association: its values may be missing.
constexpr std::uint32_t kMissingFlag = 0x80;
// Likewise: its prediction in time follows.
constexpr std::uint32_t kPredictedFlag = 0x40;

struct Header {
  std::uint32_t manifestBytes = 0, tableBytes = 0, manifestCrc = 0, tableCrc = 0;
  std::uint32_t chunks = 0, fields = 0, dependencies = 0, closing = 0, laterBytes = 0;
  std::uint64_t fileBytes = 0;
  std::uint8_t positionBits = 0;

  [[nodiscard]] std::uint64_t headBytes() const {
    return std::uint64_t{LogIndex::kHeaderBytes} + manifestBytes + tableBytes;
  }
};

Result<Header> readHeader(ByteView bytes) {
  if (bytes.size() < LogIndex::kHeaderBytes)
    return fail(ErrorCode::kTruncated,
                "a log starts with a header of 64 bytes; this has " + std::to_string(bytes.size()),
                bytes.size());
  if (!std::equal(kMagic.begin(), kMagic.end(), bytes.begin()))
    return fail(ErrorCode::kBadMagic, "this is not a qtet log (the first 8 bytes differ)", 0);
  ByteReader r(bytes.first(LogIndex::kHeaderBytes));
  r.take(kMagic.size());
  const auto major = r.read<std::uint16_t>();
  r.take(sizeof(LogIndex::kVersionMinor));
  if (major != LogIndex::kVersionMajor)
    return fail(ErrorCode::kBadVersion,
                "version " + std::to_string(major) + " of the format; this build reads version " +
                    std::to_string(LogIndex::kVersionMajor) +
                    (major < LogIndex::kVersionMajor
                         ? ": make the log again from its input with qtet simplify"
                         : ": use a newer qtet"),
                8);
  Header h;
  const auto layout = r.read<std::uint8_t>();
  h.positionBits = r.read<std::uint8_t>();
  const bool reservedAreZero = r.read<std::uint16_t>() == 0;
  h.fileBytes = r.read<std::uint64_t>();
  h.manifestBytes = r.read<std::uint32_t>();
  h.tableBytes = r.read<std::uint32_t>();
  h.manifestCrc = r.read<std::uint32_t>();
  h.tableCrc = r.read<std::uint32_t>();
  h.chunks = r.read<std::uint32_t>();
  h.fields = r.read<std::uint32_t>();
  h.dependencies = r.read<std::uint32_t>();
  h.closing = r.read<std::uint32_t>();
  h.laterBytes = r.read<std::uint32_t>();
  if (r.read<std::uint32_t>() != crc32c(bytes.first(LogIndex::kHeaderBytes - 4)))
    return fail(ErrorCode::kBadChecksum,
                "the header's CRC-32C does not match; fetch the file again",
                LogIndex::kHeaderBytes - 4);
  if (!reservedAreZero)
    return fail(ErrorCode::kBadValue,
                "a reserved byte of the header (14 or 15) is not 0; use a newer qtet", 14);
  if (layout != 0)
    return fail(ErrorCode::kBadVersion,
                "layout " + std::to_string(layout) +
                    " of the format; this build reads layout 0: make the log again from its input "
                    "with qtet simplify, or use a newer qtet",
                12);
  if (h.positionBits < kMinPositionBits || h.positionBits > kMaxPositionBits)
    return fail(ErrorCode::kBadValue,
                "a lattice of " + std::to_string(h.positionBits) + " bits; 4 to 28 are allowed",
                13);
  if (h.manifestBytes > kMaxManifestBytes)
    return fail(ErrorCode::kLimitExceeded, "the manifest is above 8 MiB", 24);
  if (h.chunks == 0)
    return fail(ErrorCode::kBadValue, "a log has at least one chunk, the base mesh", 40);
  if (h.chunks > kMaxChunks) return fail(ErrorCode::kLimitExceeded, "more than 2^20 chunks", 40);
  if (h.fields > kMaxFields) return fail(ErrorCode::kLimitExceeded, "more than 8,192 fields", 44);
  if (h.closing > kMaxClosingBlocks)
    return fail(ErrorCode::kLimitExceeded, "more than 1,024 closing blocks", 52);
  if (h.laterBytes > kMaxLaterBytes)
    return fail(ErrorCode::kLimitExceeded, "the later instants take more than 256 MiB", 56);
  if (h.headBytes() + h.laterBytes > h.fileBytes)
    return fail(ErrorCode::kBadValue, "the file's size is below that of its front", 16);
  return h;
}

// The reason why a closing row contradicts the others, or nullptr.
const char* brokenClosing(const LogIndex& index, std::uint32_t fields,
                          const ClosingBlock& closing) {
  if (closing.kind == ClosingKind::kExactField && closing.field >= fields)
    return "a closing block of a field that the log does not have; build the log again";
  const bool ofMesh =
      closing.kind == ClosingKind::kPointOrder || closing.kind == ClosingKind::kCellOrder ||
      closing.kind == ClosingKind::kExactPositions || closing.kind == ClosingKind::kOriginalCells;
  if (ofMesh && closing.field != 0)
    return "a closing block of points or cells that names a field; build the log again";
  if (index.closingBlock(closing.kind, closing.field) != &closing)
    return "two closing blocks of the same kind; build the log again";
  if (closing.kind == ClosingKind::kCellOrder &&
      index.closingBlock(ClosingKind::kPointOrder) == nullptr)
    return "the input's numbering of cells without that of its points; build the log again";
  if (closing.kind == ClosingKind::kOriginalCells &&
      index.closingBlock(ClosingKind::kCellOrder) == nullptr)
    return "the cells' original cells without the cells' numbering; build the log again";
  return nullptr;
}

// Blocks back to back from `offset` to the file's end, each kind once.
Status checkClosing(const LogIndex& index, std::uint64_t offset, const Header& header) {
  for (const ClosingBlock& closing : index.closing) {
    if (closing.block.size > kMaxBlockBytes)
      return fail(ErrorCode::kLimitExceeded, "a closing block above 256 MiB", offset);
    if (const char* what = brokenClosing(index, header.fields, closing))
      return fail(ErrorCode::kBadValue, what, offset);
    offset += closing.block.size;
  }
  if (offset + header.laterBytes != header.fileBytes)
    return fail(ErrorCode::kBadValue, "the blocks do not end where the file ends", offset);
  return {};
}

// A field's association and flags, and its prediction in time. Missing bytes stay in `r`.
Status readShape(ByteReader& r, std::uint32_t field, FieldShape& out) {
  const auto bad = [&](std::uint64_t before, const std::string& what) {
    return fail(ErrorCode::kBadValue, "field " + std::to_string(field) + what, r.offset() - before);
  };
  const auto components = r.read<std::uint8_t>();
  const auto association = r.read<std::uint8_t>();
  if (components == 0 || components > kMaxFieldComponents)
    return bad(2, " has a number of components outside 1..16");
  const bool isPredicted = (association & kPredictedFlag) != 0;
  const std::uint32_t kind = association & ~(kMissingFlag | kPredictedFlag);
  if (kind > static_cast<std::uint32_t>(Association::kCell))
    return bad(
        1,
        " has the association " + std::to_string(association) +
            "; this build knows 0 (points) and 1 (cells), 64 more for a prediction "
            "in time, and 128 more for missing values: use a newer qtet, or build the log again");
  out.components = components;
  out.association = static_cast<Association>(kind);
  out.hasMissing = (association & kMissingFlag) != 0;
  if (!isPredicted) return {};
  const auto parents = r.read<std::uint8_t>();
  if (parents == 0 || parents > TimePrediction::kMaxParents)
    return bad(1, " is predicted from other than 1 to 4 fields; fetch or build the log again");
  for (; out.prediction.count < parents; ++out.prediction.count) {
    const std::uint32_t parent = r.readVarint();
    if (parent >= field)
      return bad(1,
                 " is predicted from a field that does not come before it; fetch or build the "
                 "log again");
    out.prediction.parents[out.prediction.count] = {
        static_cast<std::uint16_t>(parent), static_cast<std::int8_t>(r.read<std::uint8_t>())};
  }
  return {};
}

// A field is predicted from fields of its own kind.
Status checkPredictions(const LogIndex& index, std::size_t first = 0) {
  for (std::size_t f = first; f < index.fields.size(); ++f)
    for (const TimePrediction::Parent& parent : index.fields[f].prediction.all())
      if (const FieldShape& of = index.fields[parent.field];
          of.components != index.fields[f].components ||
          of.association != index.fields[f].association)
        return fail(ErrorCode::kBadValue, "field " + std::to_string(f) +
                                              " is predicted from a field of another kind; fetch "
                                              "or build the log again");
  return {};
}

void writeShapes(ByteWriter& w, std::span<const FieldShape> fields) {
  for (const FieldShape& field : fields) {
    w.write(static_cast<std::uint8_t>(field.components));
    w.write(static_cast<std::uint8_t>(static_cast<std::uint32_t>(field.association) |
                                      (field.hasMissing ? kMissingFlag : 0) |
                                      (field.prediction.isNone() ? 0 : kPredictedFlag)));
    if (field.prediction.isNone()) continue;
    w.write(field.prediction.count);
    for (const TimePrediction::Parent& parent : field.prediction.all()) {
      w.writeVarint(parent.field);
      w.write(static_cast<std::uint8_t>(parent.weight));
    }
  }
}

// Fields, bytes and checksum of the part of later instants, if there is one. A field takes two
// bytes at least.
LogIndex::Unread readLaterSummary(ByteReader& r, const Header& header) {
  LogIndex::Unread out;
  out.bytes = header.laterBytes;
  out.fields = r.readVarint();
  if (out.fields > 0) out.crc = r.read<std::uint32_t>();
  if (!r.failed() && (out.fields > header.fields || (out.fields > 0) != (out.bytes > 0) ||
                      2 * std::uint64_t{out.fields} > out.bytes))
    r.fail(ErrorCode::kBadValue,
           "the table has another number of later instants than the header; fetch or build the log "
           "again");
  if (r.failed()) out = {};
  return out;
}

// As check(), for the blocks that readLater has brought. The row has had their sum from the start.
Status checkLaterBlocks(const LogIndex& index) {
  for (std::uint32_t chunk = 0; chunk < index.chunks.size(); ++chunk) {
    const ChunkEntry& e = index.chunks[chunk];
    for (const BlockEntry& b : std::span(e.blocks).last(index.laterFields)) {
      if (b.size > kMaxBlockBytes)
        return fail(ErrorCode::kLimitExceeded,
                    "a block of chunk " + std::to_string(chunk) + " above 256 MiB", b.offset);
    }
  }
  return {};
}

// Checks everything that later steps rely on: blocks that end where the file does, levels in order,
// counts within limits.
Status check(const LogIndex& index, const Header& header) {
  std::uint64_t offset = header.headBytes();
  std::uint64_t vertices = 0;
  std::uint64_t cells = 0;
  std::uint64_t triangles = 0;
  for (std::uint32_t i = 0; i < index.chunks.size(); ++i) {
    const ChunkEntry& e = index.chunks[i];
    const auto bad = [i](ErrorCode code, const char* what) {
      return fail(code, "chunk table, row " + std::to_string(i) + ": " + what +
                            "; fetch or build the log again");
    };
    for (const BlockEntry& b : e.blocks) {
      if (b.size > kMaxBlockBytes) return bad(ErrorCode::kLimitExceeded, "a block above 256 MiB");
      offset += b.size;
    }
    if (e.laterBytes > std::uint64_t{index.unread.fields} * kMaxBlockBytes)
      return bad(ErrorCode::kLimitExceeded, "more bytes of later instants than they may have");
    offset += e.laterBytes;
    vertices += e.newVertices, cells += e.newTetrahedra, triangles += e.newBoundaryTriangles;
    if (vertices > kMaxElements || cells > kMaxElements || triangles > kMaxElements)
      return bad(ErrorCode::kLimitExceeded, "more than 2^29 vertices, cells or triangles");
    if (e.structureCodec != CodecId::kRange ||
        (e.valueCodec != CodecId::kDraco && e.valueCodec != CodecId::kAdaptive &&
         e.valueCodec != CodecId::kLifted))
      return bad(ErrorCode::kBadCodec, "an unknown codec id");
    if (e.valueCodec != index.chunks[0].valueCodec)
      return bad(ErrorCode::kBadCodec, "its values have another codec than those of chunk 0");
    if (i == 0 ? e.firstLevel != 0 || e.lastLevel != 0 || e.records != 0 || e.endSlot != kLevelEnd
               : e.firstLevel == 0)
      return bad(ErrorCode::kBadValue, "levels out of order");
    // A split takes at least one step and brings at most four vertices back. It brings fewer than
    // eight cells for each cell of its star, and each of these is a step.
    const std::uint64_t steps =
        kMaxStepsPerByte * (std::uint64_t{e.blocks[kStructurePart].size} + kFreeCountBytes);
    if (e.records > steps || e.newVertices > 4 * steps || e.newTetrahedra > 8 * steps ||
        e.newBoundaryTriangles > 8 * steps)
      return bad(ErrorCode::kLimitExceeded, "it promises more than its bytes can hold");
    // so that tuples() fits its type
    if (e.records > e.newVertices) return bad(ErrorCode::kBadValue, "more records than vertices");
  }
  if (index.chunks.back().endSlot != kLevelEnd)
    return fail(ErrorCode::kBadValue,
                "the last chunk ends within a level; fetch or build the log again",
                header.headBytes());
  if (header.dependencies + 1 != index.chunks.size())
    return fail(ErrorCode::kBadValue,
                "the table has another number of dependencies than the header says; fetch or build "
                "the log again",
                48);
  return checkClosing(index, offset, header);
}

}  // namespace

std::uint64_t LogIndex::headBytes() const {
  return chunks.empty() ? kHeaderBytes : chunks.front().offset;
}

const ClosingBlock* LogIndex::closingBlock(ClosingKind kind, std::uint32_t field) const {
  const auto at = std::ranges::find_if(
      closing, [&](const ClosingBlock& c) { return c.kind == kind && c.field == field; });
  return at == closing.end() ? nullptr : &*at;
}

std::uint32_t LogIndex::tuples(std::uint32_t chunk, std::uint32_t part) const {
  assert(chunk < chunks.size() && part != kStructurePart && part < parts());
  const ChunkEntry& e = chunks[chunk];
  if (part == kPositionsPart) return e.newVertices;
  if (fields[part - kFirstFieldPart].association == Association::kCell) return e.newTetrahedra;
  return e.newVertices + e.records;
}

CodecId LogIndex::blockCodec(std::uint32_t chunk, std::uint32_t part) const {
  assert(chunk < chunks.size() && part < parts());
  const ChunkEntry& e = chunks[chunk];
  if (part == kStructurePart) return e.structureCodec;
  if (part == kPositionsPart) return positionCodec(e.valueCodec);
  return qtet::blockCodec(e.valueCodec, fields[part - kFirstFieldPart].association);
}

bool LogIndex::hasCellField() const {
  return std::ranges::any_of(
      fields, [](const FieldShape& field) { return field.association == Association::kCell; });
}

bool LogIndex::hasSeries() const {
  return std::ranges::any_of(fields,
                             [](const FieldShape& field) { return !field.prediction.isNone(); });
}

Result<std::uint64_t> LogIndex::headBytesOf(ByteView firstBytes) {
  const Result<Header> header = readHeader(firstBytes);
  if (!header) return std::unexpected(header.error());
  return header->headBytes();
}

Result<LogIndex> LogIndex::parse(ByteView file) {
  const Result<Header> header = readHeader(file);
  if (!header) return std::unexpected(header.error());
  const std::uint64_t at = header->fileBytes - header->laterBytes;
  return parse(file,
               file.subspan(static_cast<std::size_t>(std::min(at, std::uint64_t{file.size()}))));
}

Result<LogIndex> LogIndex::parse(ByteView head, ByteView later) {
  Result<LogIndex> index = parseHead(head);
  if (!index || index->unreadBytes() == 0) return index;
  if (Status s = index->readLater(later); !s) return std::unexpected(s.error());
  return index;
}

Result<LogIndex> LogIndex::parseHead(ByteView bytes) {
  const Result<Header> header = readHeader(bytes);
  if (!header) return std::unexpected(header.error());
  if (bytes.size() < header->headBytes())
    return fail(ErrorCode::kTruncated,
                "the front of the log is " + std::to_string(header->headBytes()) +
                    " bytes long, these are " + std::to_string(bytes.size()),
                bytes.size());
  const ByteView manifest = bytes.subspan(kHeaderBytes, header->manifestBytes);
  const ByteView table =
      bytes.subspan(kHeaderBytes + std::size_t{header->manifestBytes}, header->tableBytes);
  if (crc32c(manifest) != header->manifestCrc)
    return fail(ErrorCode::kBadChecksum,
                "the manifest's CRC-32C does not match; fetch the file again", kHeaderBytes);
  if (crc32c(table) != header->tableCrc)
    return fail(ErrorCode::kBadChecksum,
                "the chunk table's CRC-32C does not match; fetch the file again",
                kHeaderBytes + std::uint64_t{header->manifestBytes});
  LogIndex index;
  index.positionBits = header->positionBits;
  index.fileBytes = header->fileBytes;
  index.manifest.assign(manifest.begin(), manifest.end());
  ByteReader r(table, kHeaderBytes + std::uint64_t{header->manifestBytes});
  index.unread = readLaterSummary(r, *header);
  for (std::uint32_t f = 0; f < header->fields - index.unread.fields; ++f) {
    if (Status s = readShape(r, f, index.fields.emplace_back()); !s || r.failed())
      return std::unexpected(r.failed() ? r.error() : s.error());
  }
  if (r.failed()) return std::unexpected(r.error());
  if (Status s = checkPredictions(index); !s) return std::unexpected(s.error());
  const RowParts parts{index.parts(), index.unread.fields > 0};
  // before rows are allocated
  if (r.remaining() <
      header->chunks * minRowBytes(parts) + std::uint64_t{header->closing} * kMinClosingRowBytes)
    return fail(ErrorCode::kBadValue,
                "the chunk table is too short for the counts of chunks, fields and closing blocks; "
                "fetch the file again",
                28);
  index.chunks = readChunkRows(r, header->chunks, parts, header->headBytes());
  if (!r.failed()) {
    const ChunkEntry& last = index.chunks.back();
    index.closing = readClosingRows(r, header->closing, last.offset + last.size());
  }
  if (!r.failed() && r.remaining() > 0)
    r.fail(ErrorCode::kBadValue,
           "bytes behind the chunk table's last row; fetch or build the log again");
  if (r.failed()) return std::unexpected(r.error());
  if (Status s = check(index, *header); !s) return std::unexpected(s.error());
  return index;
}

Status LogIndex::readLater(ByteView part) {
  assert(unread.bytes > 0 && unread.bytes <= fileBytes);
  const std::uint64_t at = fileBytes - unread.bytes;
  if (part.size() < unread.bytes)
    return fail(ErrorCode::kTruncated,
                "the later instants take " + std::to_string(unread.bytes) + " bytes, these are " +
                    std::to_string(part.size()),
                at + part.size());
  const ByteView bytes = part.first(unread.bytes);
  if (crc32c(bytes) != unread.crc)
    return fail(ErrorCode::kBadChecksum,
                "the CRC-32C of the later instants does not match; fetch the file again", at);
  ByteReader r(bytes, at);
  const auto before = static_cast<std::uint32_t>(fields.size());
  for (std::uint32_t f = before; f < before + unread.fields; ++f) {
    if (Status s = readShape(r, f, fields.emplace_back()); !s || r.failed())
      return r.failed() ? std::unexpected(r.error()) : s;
  }
  if (Status s = checkPredictions(*this, before); !s) return s;
  const std::uint32_t manifestBytes = r.readVarint();
  if (manifestBytes > kMaxManifestBytes)
    return fail(ErrorCode::kLimitExceeded, "the manifest of later instants is above 8 MiB",
                r.offset());
  laterOffset = r.offset();
  const ByteView manifestOfLater = r.take(manifestBytes);
  laterManifest.assign(manifestOfLater.begin(), manifestOfLater.end());
  if (!r.failed() && r.remaining() < std::uint64_t{unread.fields} * chunks.size() * 5)
    r.fail(ErrorCode::kBadValue,
           "the part of later instants is too short for its fields; fetch the file again");
  if (!r.failed()) readLaterBlocks(r, unread.fields, chunks);
  if (!r.failed() && r.remaining() > 0)
    r.fail(ErrorCode::kBadValue, "bytes behind the later instants; fetch or build the log again");
  if (r.failed()) return std::unexpected(r.error());
  laterFields = unread.fields;
  unread = {};
  return checkLaterBlocks(*this);
}

Bytes LogIndex::encodeLater() const {
  assert(unread.bytes == 0 && laterFields <= fields.size());
  ByteWriter out;
  if (laterFields == 0) return out.take();
  writeShapes(out, std::span(fields).last(laterFields));
  out.writeVarint(static_cast<std::uint32_t>(laterManifest.size()));
  out.append(laterManifest);
  writeLaterBlocks(out, laterFields, chunks);
  return out.take();
}

Bytes LogIndex::encode() const {
  assert(unread.bytes == 0 && laterFields <= fields.size());
  const std::span front = std::span(fields).first(fields.size() - laterFields);
  const Bytes later = encodeLater();
  ByteWriter table;
  table.writeVarint(laterFields);
  if (laterFields > 0) table.write(crc32c(later));
  writeShapes(table, front);
  writeChunkRows(table, chunks,
                 {kFirstFieldPart + static_cast<std::uint32_t>(front.size()), laterFields > 0});
  writeClosingRows(table, closing);

  ByteWriter w;
  w.append(kMagic);
  w.write(kVersionMajor);
  w.write(kVersionMinor);
  w.write(std::uint8_t{0});  // layout
  w.write(positionBits);
  w.write(std::uint16_t{0});
  w.write(fileBytes);
  w.write(static_cast<std::uint32_t>(manifest.size()));
  w.write(static_cast<std::uint32_t>(table.bytes().size()));
  w.write(crc32c(manifest));
  w.write(crc32c(table.bytes()));
  w.write(static_cast<std::uint32_t>(chunks.size()));
  w.write(static_cast<std::uint32_t>(fields.size()));
  w.write(static_cast<std::uint32_t>(chunks.size() - 1));  // dependencies
  w.write(static_cast<std::uint32_t>(closing.size()));
  w.write(static_cast<std::uint32_t>(later.size()));
  w.write(crc32c(w.bytes()));
  assert(w.bytes().size() == kHeaderBytes);
  w.append(manifest);
  w.append(table.bytes());
  return w.take();
}

}  // namespace qtet
