// Encodes a simplifier's history as a log (FORMAT.md). Deterministic: the same input gives the same
// bytes.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include "codec/log/closing_block.h"
#include "codec/log/codec_id.h"
#include "codec/log/field_lifting.h"
#include "codec/record/fusion_history.h"
#include "proto/byte_sink.h"
#include "proto/error.h"
#include "proto/level_error.h"
#include "proto/manifest.h"

namespace qtet {

/// The input's mesh as the log's last level has it, while it is encoded.
struct FinestMesh {
  std::span<const LatticePoint> points;
  std::span<const Tetrahedron> tetrahedra;
  std::span<const VertexId> historyVertices;  ///< of each point, the history's vertex
  std::span<const CellId> historyCells;       ///< of each tetrahedron, the history's cell
};

/// Takes a closing block of that kind (of kExactField, of that field).
using ClosingSink = std::function<Status(ClosingKind kind, std::uint32_t field, ByteView block)>;

struct LogWriterOptions {
  std::string source;     ///< the input's file name, for the manifest
  std::string generator;  ///< "qtet 0.4.0"
  /// A chunk ends at the record that takes it beyond; the first ones are smaller, from 4 KB on.
  std::uint32_t chunkBytes = 64 << 10;
  CodecId valueCodec = CodecId::kLifted;  ///< kLifted, kDraco or kAdaptive
  /// One list a field, for kLifted; exactRules without. A cell field has none.
  std::vector<LiftingRules> rules{};
  /// For the manifest: none, or one a level, coarse-first, the input's mesh included.
  LevelErrors errors;
  std::optional<Focus> focus = std::nullopt;      ///< for the manifest
  std::optional<Opening> opening = std::nullopt;  ///< the same
  Units units{};                                  ///< the same
  Labels labels{};                                ///< the same
  std::optional<OriginalSize> original{};         ///< the same
  /// Gives the closing blocks, once the chunks are written; none without it.
  std::function<Status(const FinestMesh&, const ClosingSink&)> closing{};
  std::function<void(double)> progress{};  ///< fraction of the geometry done, 0..1
  std::stop_token stop{};                  ///< asked at every record, and at every field
};

struct LogStatistics {
  std::uint64_t headBytes = 0;       ///< header, manifest, table, and the part of later instants
  std::uint64_t structureBytes = 0;  ///< without what positions take of them
  std::uint64_t positionBytes = 0;   ///< with that: placements, remainders, digits
  std::vector<std::uint64_t> fieldBytes;
  std::uint64_t baseBytes = 0;  ///< of the above, what chunk 0 takes
  std::uint64_t fileBytes = 0;
  std::uint64_t records = 0;
  std::uint64_t steps = 0;  ///< of a reader's work (Refiner::steps)
  std::uint32_t chunks = 0;
  std::uint32_t levels = 0;  ///< without the base mesh
};

/// A log without its blocks, and the figures of all of it.
struct EncodedHead {
  Bytes head;   ///< header, manifest, table: the file is these bytes, then all blocks, then `later`
  Bytes later;  ///< the part of later instants; mostly empty
  LogStatistics statistics;
};

class RecordWriter;

/// Writes the history backwards, coarse-first: the geometry, then field after field.
class LogEncoder {
 public:
  /// `history` must outlive it. Its values may change until finish().
  LogEncoder(const FusionHistory& history, LogWriterOptions options);
  ~LogEncoder();
  LogEncoder(const LogEncoder&) = delete;
  LogEncoder& operator=(const LogEncoder&) = delete;

  /// Errors: bad-value (the history contradicts itself or holds a fusion that no label coding
  /// describes), limit-exceeded, cancelled. REQUIRES: called once and first.
  Status writeGeometry();
  /// The order in which fields are coded.
  [[nodiscard]] const ValueOrder& order();
  /// Those that finish() reads: all that tell of fields, and of the manifest.
  [[nodiscard]] LogWriterOptions& options() { return options_; }
  /// `body` takes the blocks in file order, once all are coded. Errors: bad-value, limit-exceeded,
  /// bad-codec, cancelled, the sink's. REQUIRES: called once and last.
  [[nodiscard]] Result<EncodedHead> finish(const ByteSink& body);

 private:
  const FusionHistory& history_;
  LogWriterOptions options_;
  std::unique_ptr<RecordWriter> writer_;
};

struct EncodedLog {
  Bytes bytes;
  LogStatistics statistics;
};

/// All of it in memory. Errors: LogEncoder's.
[[nodiscard]] Result<EncodedLog> encodeLog(const FusionHistory& history,
                                           const LogWriterOptions& options);

}  // namespace qtet
