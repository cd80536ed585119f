// How a patch decoder reads records: one split after the other, into the mesh that grows. For
// patch_decoder.* and nobody else.
#pragma once

#include <cstdint>
#include <optional>

#include "codec/log/work_meter.h"
#include "codec/mesh/coarse_part.h"
#include "codec/mesh/growing_mesh.h"
#include "codec/record/cell_values.h"
#include "codec/record/point_values.h"
#include "codec/record/record_coder.h"
#include "codec/record/values.h"
#include "codec/refine/patch_block.h"
#include "codec/refine/patch_requests.h"

namespace qtet {

/// The part of the mesh's past that fields need, so that their blocks may arrive later.
struct Ancestry {
  PointAncestry points;
  std::optional<CellAncestry> cells;  // where there is a cell field
};

/// The facts that decoding a patch takes beside its coarse part and its blocks.
struct PatchKind {
  int positionBits = 0;  ///< of the lattice
  bool hasPointFields = false, hasCellFields = false;
};

/// The mesh, and what reading a record takes beside it.
class RecordReader {
 public:
  /// `requests` must outlive it.
  RecordReader(const PatchKind& kind, const PatchRequests& requests);

  /// Bytes that makeRoom() takes.
  [[nodiscard]] std::uint64_t roomFor(const Slots& total, std::uint64_t records) const;
  /// A hint: so much is to come. REQUIRES: there is memory for it.
  void makeRoom(const Slots& total, std::uint64_t records);
  /// Takes the coarse part. REQUIRES: called once and first; ids in range, coordinates in the
  /// lattice.
  void start(const CoarsePart& coarse);
  /// The coder with which vertex() reads the chunk's records.
  [[nodiscard]] RecordCoder<RangeDecoder> coderOf(PatchBlock& chunk) {
    return {chunk.decoder, models_, mesh_, link_, chunk.positions};
  }
  /// Reads the split flag of v, and its record if it splits. REQUIRES: v may split.
  Status vertex(const PatchBlock& chunk, RecordCoder<RangeDecoder>& coder, VertexId v);
  /// Whether a whole chunk brought what the chunk table says.
  [[nodiscard]] Status checkCounts(const PatchBlock& chunk) const;

  [[nodiscard]] GrowingMesh& mesh() { return mesh_; }
  [[nodiscard]] const GrowingMesh& mesh() const { return mesh_; }
  /// Takes that many steps, or refuses the chunk with limit-exceeded.
  [[nodiscard]] Status work(const PatchBlock& chunk, std::uint64_t steps);
  [[nodiscard]] WorkMeter& meter() { return meter_; }
  [[nodiscard]] const WorkMeter& meter() const { return meter_; }
  [[nodiscard]] const Ancestry& ancestry() const { return ancestry_; }
  /// Records so far.
  [[nodiscard]] std::size_t records() const { return ancestry_.points.births().size(); }

 private:
  Status split(const PatchBlock& chunk, RecordCoder<RangeDecoder>& coder, VertexId v);

  const std::int32_t latticeSize_;  // cells along an axis
  const int positionBits_;
  const PatchRequests& requests_;
  GrowingMesh mesh_;
  Link link_;
  Split inHand_;
  RecordModels models_;
  Ancestry ancestry_;
  WorkMeter meter_;
};

}  // namespace qtet
