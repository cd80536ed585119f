// How a refiner reads records: the base mesh and one split after the other, into the mesh that
// grows. For refiner*.cpp and nobody else.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "codec/log/log_index.h"
#include "codec/log/work_meter.h"
#include "codec/mesh/growing_mesh.h"
#include "codec/record/base_coder.h"
#include "codec/record/cell_values.h"
#include "codec/record/point_values.h"
#include "codec/record/record_coder.h"
#include "codec/record/values.h"
#include "codec/refine/refiner.h"
#include "proto/limits.h"

namespace qtet {

[[nodiscard]] std::unexpected<Error> refuseChunk(ErrorCode code, std::uint32_t chunk,
                                                 const std::string& what);

/// The chunk table, and what follows from it.
struct ChunkPlan {
  explicit ChunkPlan(LogIndex logIndex);

  LogIndex index;
  std::vector<Slots> slots;  // of each chunk the first, and the end
};

/// The caller's requests: where to stop, whom to notify.
struct RefinerSettings {
  std::uint32_t stopLevel = kMaxLevels + 1;
  SplitObserver* observer = nullptr;
  LevelGate* gate = nullptr;

  [[nodiscard]] Status mayGoOn() const {
    return gate == nullptr || gate->goOn() ? Status{}
                                           : fail(ErrorCode::kIo, "stopped, as was asked for");
  }
};

/// The part of the mesh's past that fields need, so that their blocks may arrive later.
struct Ancestry {
  std::vector<BaseBirth> base;
  PointAncestry points;
  std::optional<CellAncestry> cells;  // where there is a cell field
};

/// A chunk while it is read.
struct ChunkInput {
  std::uint32_t number;
  const ChunkEntry& entry;
  RangeDecoder decoder;
  Values& positions;
  Slots end;            // of the slots that it may fill
  std::size_t records;  // how many there may be at its end, of all chunks

  [[nodiscard]] std::unexpected<Error> refuse(ErrorCode code, const std::string& what) const {
    return refuseChunk(code, number, what);
  }
  [[nodiscard]] std::unexpected<Error> refuseBase() const;
  [[nodiscard]] std::unexpected<Error> refuseLength() const;
};

/// The mesh, and what reading a record takes beside it.
class RecordReader {
 public:
  /// Both must outlive it.
  RecordReader(const ChunkPlan& plan, const RefinerSettings& settings);

  /// Bytes that makeRoomForAll() takes.
  [[nodiscard]] std::uint64_t roomForAll() const;
  /// A hint: the whole log is to come. REQUIRES: there is memory for it.
  void makeRoomForAll();
  /// Reads the base mesh. REQUIRES: called once and first.
  Status base(ChunkInput& chunk);
  /// The coder with which vertex() reads the chunk's records.
  [[nodiscard]] RecordCoder<RangeDecoder> coderOf(ChunkInput& chunk) {
    return {chunk.decoder, models_, mesh_, link_, chunk.positions};
  }
  /// Reads the split flag of v, and its record if it splits. REQUIRES: v may split.
  Status vertex(const ChunkInput& chunk, RecordCoder<RangeDecoder>& coder, VertexId v);
  /// Whether a whole chunk brought what the chunk table says.
  [[nodiscard]] Status checkCounts(const ChunkInput& chunk) const;

  [[nodiscard]] GrowingMesh& mesh() { return mesh_; }
  [[nodiscard]] const GrowingMesh& mesh() const { return mesh_; }
  /// Takes that many steps, or refuses the chunk with limit-exceeded.
  [[nodiscard]] Status work(const ChunkInput& chunk, std::uint64_t steps);
  [[nodiscard]] WorkMeter& meter() { return meter_; }
  [[nodiscard]] const WorkMeter& meter() const { return meter_; }
  [[nodiscard]] const Ancestry& ancestry() const { return ancestry_; }
  /// Records so far.
  [[nodiscard]] std::size_t records() const { return ancestry_.points.births().size(); }

 private:
  Status split(const ChunkInput& chunk, RecordCoder<RangeDecoder>& coder, VertexId v);
  [[nodiscard]] std::uint64_t recordsOfAll() const;

  const ChunkPlan& plan_;
  const RefinerSettings& settings_;
  GrowingMesh mesh_;
  Link link_;
  Split inHand_;
  RecordModels models_;
  Ancestry ancestry_;
  WorkMeter meter_;
};

}  // namespace qtet
