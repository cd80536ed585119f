// Writes the base mesh and one record after the other into the open chunk, and applies them to the
// mirror of the decoder's mesh.
#pragma once

#include <cstdint>
#include <span>
#include <stop_token>
#include <vector>

#include "codec/log/chunk_writer.h"
#include "codec/log/field_estimate.h"
#include "codec/log/work_meter.h"
#include "codec/mesh/link.h"
#include "codec/record/fusion_history.h"
#include "codec/record/mirror_mesh.h"
#include "codec/record/record_coder.h"
#include "codec/record/split_describer.h"

namespace qtet {

class RecordWriter {
 public:
  /// `history` must outlive it. `stop` is asked at every record.
  RecordWriter(const FusionHistory& history, CodecId valueCodec, std::stop_token stop);
  RecordWriter(const RecordWriter&) = delete;
  RecordWriter& operator=(const RecordWriter&) = delete;

  /// Writes the base mesh into chunk 0, which stays open. Errors: bad-value, cancelled. REQUIRES:
  /// called once and first, or patch() is.
  Status base();
  /// Begins a patch instead, with the coarse part that its reader has: chunk 0 stays empty. `cells`
  /// and `vertices` are the history's. Errors: bad-value. REQUIRES: a history without fields.
  Status patch(const CoarsePart& coarse, std::span<const std::uint32_t> cells,
               std::span<const VertexId> vertices);
  /// Writes the split flag of v in the current level (GrowingMesh::beginLevel). The fusion that its
  /// split undoes, or nullptr. REQUIRES: v may split.
  [[nodiscard]] const Fusion* flag(VertexId v);
  /// Writes the record of v and splits it. Errors: bad-value, cancelled. REQUIRES: flag(v) gave
  /// `fusion`.
  Status record(VertexId v, Fusion fusion);
  /// Ends the open chunk. Errors: those of ChunkWriter::close; limit-exceeded where a reader would
  /// refuse so much work for so few bytes.
  Status closeChunk(std::uint32_t lastLevel, std::uint32_t endSlot);

  [[nodiscard]] ChunkWriter& chunks() { return chunks_; }
  /// Counts the work that is written. The caller counts levels.
  [[nodiscard]] WorkMeter& meter() { return meter_; }
  [[nodiscard]] RecordModels& models() { return models_; }
  [[nodiscard]] GrowingMesh& mesh() { return mirror_.mesh(); }
  [[nodiscard]] const MirrorMesh& mirror() const { return mirror_; }
  /// The order in which fields are coded. REQUIRES: all is written.
  [[nodiscard]] const ValueOrder& order();
  /// The slots that each level has added so far, the base mesh first.
  [[nodiscard]] const std::vector<Slots>& added() const { return added_; }
  /// The positions' share of the structure blocks, in 64ths of a bit.
  [[nodiscard]] std::uint64_t positionCost() const { return coder_.positionCost(); }
  /// Fraction of the history's cells that are written.
  [[nodiscard]] double done() const {
    return static_cast<double>(mirror_.tetrahedra().size()) /
           static_cast<double>(history_.cells.size());
  }

 private:
  Status start(const CoarsePart& coarse, std::span<const std::uint32_t> cells,
               std::span<const VertexId> vertices);

  const FusionHistory& history_;
  std::stop_token stop_;
  ChunkWriter chunks_;
  MirrorMesh mirror_;
  SplitDescriber describer_;
  const FieldEstimate estimate_;
  const bool hasCellFields_;
  ValueOrder order_;
  Link link_;
  RecordModels models_;
  RecordCoder<RangeEncoder> coder_;
  std::vector<Slots> added_;
  WorkMeter meter_;
};

}  // namespace qtet
