// Encodes a simplifier's history as a log (FORMAT.md). Deterministic: the same input gives the same
// bytes.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "codec/log/codec_id.h"
#include "codec/record/fusion_history.h"
#include "proto/bytes.h"
#include "proto/error.h"
#include "proto/level_error.h"
#include "proto/manifest.h"

namespace qtet {

struct LogWriterOptions {
  std::string source;     ///< the input's file name, for the manifest
  std::string generator;  ///< "qtet 0.3.0"
  /// A chunk ends at the record that takes it beyond; the first ones are smaller, from 4 KB on.
  std::uint32_t chunkBytes = 64 << 10;
  CodecId valueCodec = CodecId::kDraco;  ///< kDraco or kAdaptive
  /// For the manifest: none, or one a level, coarse-first, the input's mesh included.
  LevelErrors errors;
  std::optional<Focus> focus = std::nullopt;      ///< for the manifest
  std::optional<Opening> opening = std::nullopt;  ///< the same
  std::function<void(double)> progress;           ///< fraction done, 0..1
  std::stop_token stop{};                         ///< asked at every record
};

struct LogStatistics {
  std::uint64_t headBytes = 0;       ///< header, manifest, table
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

struct EncodedLog {
  Bytes bytes;
  LogStatistics statistics;
  std::vector<VertexId> points;    ///< slot of the last level -> the history's vertex
  std::vector<CellId> tetrahedra;  ///< and its cell
};

/// Writes the history backwards, coarse-first. Errors: bad-value (the history contradicts itself or
/// holds a fusion that no label coding describes), limit-exceeded, bad-codec, cancelled.
[[nodiscard]] Result<EncodedLog> encodeLog(const FusionHistory& history,
                                           const LogWriterOptions& options);

}  // namespace qtet
