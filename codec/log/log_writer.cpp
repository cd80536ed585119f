#include "codec/log/log_writer.h"

#include <algorithm>
#include <cassert>
#include <optional>
#include <string>
#include <utility>

#include "codec/log/field_blocks.h"
#include "codec/log/level_runs.h"
#include "codec/log/log_index.h"
#include "codec/log/log_manifest.h"
#include "codec/log/manifest_field.h"
#include "codec/log/record_writer.h"
#include "proto/crc32c.h"
#include "proto/limits.h"

namespace qtet {
namespace {

Status checkErrors(const FusionHistory& history, const LevelErrors& errors) {
  if (errors.empty() || errors.size() == history.levels + 1u) return {};
  return fail(ErrorCode::kBadValue, "there are known errors of " + std::to_string(errors.size()) +
                                        " levels, but " + std::to_string(history.levels + 1u) +
                                        " levels; measure the history that is encoded");
}

Status checkLimits(const FusionHistory& history) {
  if (history.levels > kMaxLevels) return fail(ErrorCode::kLimitExceeded, "more than 4,096 levels");
  if (history.fields.size() > kMaxFields)
    return fail(ErrorCode::kLimitExceeded, "more than 8,192 fields; choose some with `fields`");
  if (history.points.size() > kMaxElements || history.cells.size() > kMaxElements)
    return fail(ErrorCode::kLimitExceeded, "more than 2^29 cells");
  return {};
}

Status checkCellFields(const FusionHistory& history) {
  const auto ghosts = std::ranges::count_if(
      history.cells, [](const auto& c) { return std::ranges::find(c, kGhost) != c.end(); });
  const std::size_t tetrahedra = history.cells.size() - static_cast<std::size_t>(ghosts);
  for (std::size_t f = 0; f < history.fields.size(); ++f) {
    const FieldInfo& field = history.fields[f];
    if (isCellField(field) && history.values[f].size() != tetrahedra * field.components)
      return fail(ErrorCode::kBadValue,
                  "cell field " + field.name + " has " + std::to_string(history.values[f].size()) +
                      " numbers for " + std::to_string(tetrahedra) + " tetrahedra");
  }
  return {};
}

Status writeStream(RecordWriter& writer, const FusionHistory& history,
                   const LogWriterOptions& options) {
  if (Status s = writeLevelRuns(writer, history.levels, options); !s) return s;
  return writer.closeChunk(history.levels, kLevelEnd);
}

/// Codes the fields one after the other, and gives the blocks of all chunks to `body`.
Status writeChunks(RecordWriter& writer, const FusionHistory& history,
                   const LogWriterOptions& options, const ByteSink& body) {
  const ValueOrder& order = writer.order();
  std::vector<std::vector<Bytes>> fields;
  for (std::size_t f = 0; f < history.fields.size(); ++f) {
    if (options.stop.stop_requested()) return cancelled();
    Result<std::vector<Bytes>> blocks =
        encodeFieldBlocks(order, history.fields[f], history.values[f], options.valueCodec,
                          options.rules.empty() ? LiftingRules{} : options.rules[f]);
    if (!blocks) return std::unexpected(blocks.error());
    fields.push_back(std::move(*blocks));
  }
  std::vector<ChunkEntry>& rows = writer.chunks().rows();
  for (std::size_t chunk = 0; chunk < rows.size(); ++chunk) {
    if (Status s = body(writer.chunks().geometry()[chunk]); !s) return s;
    for (const std::vector<Bytes>& blocks : fields) {
      if (Status s = ChunkWriter::addBlock(rows[chunk], blocks[chunk]); !s) return s;
      if (Status s = body(blocks[chunk]); !s) return s;
    }
  }
  return {};
}

/// Gives the closing blocks to `body`, and their rows.
Result<std::vector<ClosingBlock>> writeClosing(const RecordWriter& writer,
                                               const LogWriterOptions& options,
                                               const ByteSink& body) {
  std::vector<ClosingBlock> rows;
  if (!options.closing) return rows;
  const auto take = [&](ClosingKind kind, std::uint32_t field, ByteView block) -> Status {
    if (block.size() > kMaxBlockBytes)
      return fail(ErrorCode::kLimitExceeded,
                  "a closing block above 256 MiB; leave out `lossless` or `keepOrder`");
    rows.push_back({kind, field, {0, static_cast<std::uint32_t>(block.size()), crc32c(block)}});
    return body(block);
  };
  const MirrorMesh& mirror = writer.mirror();
  if (Status s = options.closing(
          {mirror.mesh().points, mirror.mesh().tetrahedra, mirror.vertices(), mirror.tetrahedra()},
          take);
      !s)
    return std::unexpected(s.error());
  return rows;
}

Status checkRecords(const FusionHistory& history, const std::vector<ChunkEntry>& rows) {
  std::uint64_t records = 0;
  for (const ChunkEntry& row : rows) records += row.records;
  return records == history.fusions.size() ? Status{}
                                           : fail(ErrorCode::kBadValue,
                                                  "a fusion of the history belongs to a level in "
                                                  "which its vertex is not; simplify "
                                                  "the mesh again");
}

std::vector<ManifestLevel> levelsOf(const std::vector<Slots>& added, const LevelErrors& errors) {
  std::vector<ManifestLevel> out;
  Slots sum;
  for (std::uint32_t level = 0; level < added.size(); ++level) {
    sum = {sum.vertices + added[level].vertices, sum.tetrahedra + added[level].tetrahedra,
           sum.triangles + added[level].triangles};
    // the table has the chunk
    out.push_back({level, sum.tetrahedra, sum.vertices, sum.triangles, 0, std::nullopt});
    if (!errors.empty()) out.back().error = errors[level];
  }
  return out;
}

Manifest manifestFor(const FusionHistory& history, const LogWriterOptions& options,
                     const std::vector<Slots>& added) {
  Manifest m;
  m.generator = options.generator;
  m.source = options.source;
  m.latticeBits = history.lattice.bits;
  m.latticeStep = history.lattice.step;
  m.latticeOrigin = history.lattice.origin;
  m.focus = options.focus;
  m.opening = options.opening;
  m.units = options.units;
  m.labels = options.labels;
  m.original = options.original;
  for (const FieldInfo& f : history.fields) m.fields.push_back(manifestFieldOf(f));
  m.levels = levelsOf(added, options.errors);
  return m;
}

/// Without offsets, which follow from the length of its own bytes.
Result<LogIndex> indexOf(const FusionHistory& history, const LogWriterOptions& options,
                         RecordWriter& writer) {
  LogIndex index;
  index.positionBits = static_cast<std::uint8_t>(history.lattice.bits);
  for (const FieldInfo& f : history.fields)
    index.fields.push_back({f.components, isCellField(f) ? Association::kCell : Association::kPoint,
                            f.hasMissing, f.prediction});
  if (Status s = setManifest(index, manifestFor(history, options, writer.added())); !s)
    return std::unexpected(s.error());
  index.chunks = std::move(writer.chunks().rows());
  return index;
}

LogStatistics statisticsOf(const LogIndex& index, std::uint64_t laterBytes,
                           const FusionHistory& history, std::uint64_t positionCost) {
  LogStatistics s;
  s.headBytes = s.fileBytes = index.encode().size() + laterBytes;
  s.fieldBytes.resize(index.fields.size());
  for (const ChunkEntry& row : index.chunks) {
    for (std::size_t part = 0; part < row.blocks.size(); ++part) {
      s.fileBytes += row.blocks[part].size;
      (part == kStructurePart   ? s.structureBytes
       : part == kPositionsPart ? s.positionBytes
                                : s.fieldBytes[part - kFirstFieldPart]) += row.blocks[part].size;
    }
    if (&row == &index.chunks.front()) s.baseBytes = s.fileBytes - s.headBytes;
  }
  for (const ClosingBlock& row : index.closing) s.fileBytes += row.block.size;
  const std::uint64_t positionBytes = positionCost / (64 * 8);
  s.structureBytes -= positionBytes;
  s.positionBytes += positionBytes;
  s.chunks = static_cast<std::uint32_t>(index.chunks.size());
  s.levels = history.levels;
  s.records = history.fusions.size();
  return s;
}

}  // namespace

LogEncoder::LogEncoder(const FusionHistory& history, LogWriterOptions options)
    : history_(history), options_(std::move(options)) {}
LogEncoder::~LogEncoder() = default;

const ValueOrder& LogEncoder::order() { return writer_->order(); }

Status LogEncoder::writeGeometry() {
  assert(!writer_);
  if (Status s = checkLimits(history_); !s) return s;
  if (Status s = checkCellFields(history_); !s) return s;
  writer_ = std::make_unique<RecordWriter>(history_, options_.valueCodec, options_.stop);
  if (Status s = writer_->base(); !s) return s;
  if (Status s = writeStream(*writer_, history_, options_); !s) return s;
  return checkRecords(history_, writer_->chunks().rows());
}

Result<EncodedHead> LogEncoder::finish(const ByteSink& body) {
  assert(writer_);
  if (Status s = checkErrors(history_, options_.errors); !s) return std::unexpected(s.error());
  if (Status s = writeChunks(*writer_, history_, options_, body); !s)
    return std::unexpected(s.error());
  Result<LogIndex> index = indexOf(history_, options_, *writer_);
  if (!index) return std::unexpected(index.error());
  Result<std::vector<ClosingBlock>> closing = writeClosing(*writer_, options_, body);
  if (!closing) return std::unexpected(closing.error());
  index->closing = std::move(*closing);
  Result<Bytes> later = laterPart(*index);
  if (!later) return std::unexpected(later.error());
  EncodedHead log;
  log.later = std::move(*later);
  log.statistics = statisticsOf(*index, log.later.size(), history_, writer_->positionCost());
  log.statistics.steps = writer_->meter().steps();
  index->fileBytes = log.statistics.fileBytes;
  log.head = index->encode();
  return log;
}

Result<EncodedLog> encodeLog(const FusionHistory& history, const LogWriterOptions& options) {
  Bytes body;
  LogEncoder encoder(history, options);
  if (Status s = encoder.writeGeometry(); !s) return std::unexpected(s.error());
  Result<EncodedHead> head = encoder.finish(appendTo(body));
  if (!head) return std::unexpected(head.error());
  EncodedLog log{std::move(head->head), std::move(head->statistics)};
  log.bytes.insert(log.bytes.end(), body.begin(), body.end());
  log.bytes.insert(log.bytes.end(), head->later.begin(), head->later.end());
  return log;
}

}  // namespace qtet
