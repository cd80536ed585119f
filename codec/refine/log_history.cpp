#include "codec/refine/log_history.h"

#include <algorithm>
#include <cassert>
#include <map>
#include <numeric>
#include <string>
#include <utility>

#include "codec/log/field_blocks.h"
#include "codec/log/log_manifest.h"
#include "codec/mesh/time_prediction.h"
#include "codec/refine/log_file.h"
#include "codec/refine/patch_block.h"
#include "codec/refine/refiner.h"

namespace qtet {
namespace {

/// Writes down every split of a log on its way to the last level, with slots in place of the
/// history's vertices.
class SplitRecorder final : public SplitObserver {
 public:
  explicit SplitRecorder(LogHistory& out) : out_(out) {}

  void beforeSplit(VertexId v, const GrowingMesh& mesh, const Link& link,
                   const Split& split) override {
    FusionHistory& h = out_.history;
    Fusion fusion;
    fusion.k = static_cast<std::uint8_t>(split.k);
    fusion.placement = split.placement;
    fusion.level = mesh.level();
    fusion.fused = v;
    fusion.firstAffected = h.affectedCells.size();
    fusion.firstDeleted = h.deletedCells.size();
    fusion.affectedCount = static_cast<std::uint32_t>(mesh.star(v).size());
    fusion.deletedCount = static_cast<std::uint32_t>(split.deleted.size());
    near.push_back(static_cast<std::uint8_t>(split.near));
    fusedPoints.push_back(mesh.points[v]);
    for (std::size_t f = 0; f < fusion.affectedCount; ++f) {
      const CellRef cell = mesh.star(v)[f];
      h.affectedCells.push_back(cell & kBoundaryBit ? out_.tetrahedra + (cell & ~kBoundaryBit)
                                                    : cell);
      h.affectedLabels.push_back(link.triangles()[f].label);
    }
    std::uint32_t tetrahedron = mesh.next().tetrahedra,
                  triangle = out_.tetrahedra + mesh.next().triangles;
    for (const LocalCell& cell : split.deleted) {
      const bool ghost = std::ranges::any_of(
          cell, [&](LocalVertex x) { return !(x & kPreyBit) && link.vertices()[x] == kGhost; });
      h.deletedCells.push_back(ghost ? triangle++ : tetrahedron++);
    }
    h.fusions.push_back(fusion);
    out_.order.points.add(v, mesh, link, split);
    out_.order.cells.addRestored(mesh.star(v), link, split.deleted, mesh.next().tetrahedra);
  }

  std::vector<std::uint8_t> near;
  std::vector<LatticePoint> fusedPoints;

 private:
  LogHistory& out_;
};

Status decodeBase(const LogFile& log, LogHistory& out) {
  const ChunkEntry& entry = log.chunks().front();
  RangeDecoder decoder(log.block(0, kStructurePart));
  BaseCoder<RangeDecoder> coder(decoder, entry.newVertices, entry.newTetrahedra);
  if (!coder.run(nullptr, [&] { return decoder.overrun(); }))
    return fail(ErrorCode::kBadValue, "the base mesh's structure contradicts itself");
  out.order.baseBirths = std::move(coder.births);
  out.order.cells.addBase(coder.tetrahedra);
  return {};
}

/// Gives every split's vertices their numbers in the history. Sorts the fusions in the order of
/// execution: from the last split to the first.
void number(const SplitRecorder& recorder, LogHistory& out) {
  FusionHistory& h = out.history;
  std::vector<VertexId> vertexOf(out.vertices);  // slot -> the vertex that is there
  for (VertexId v = 0; v < out.vertices; ++v) vertexOf[v] = v;
  out.order.prey.resize(h.fusions.size());
  out.order.fused.resize(h.fusions.size());
  for (std::size_t b = h.fusions.size(); b-- > 0;) {
    Fusion& fusion = h.fusions[b];
    const Birth& birth = out.order.points.births()[b];
    std::array<VertexId, 4>& prey = out.order.prey[b];
    for (std::size_t i = 0; i < birth.k; ++i) prey[i] = vertexOf[birth.preySlot(i)];
    fusion.prey = prey;
    const std::uint8_t near = recorder.near[b];
    std::swap(fusion.prey[0], fusion.prey[near]);
    for (std::uint64_t i = fusion.firstAffected; i < fusion.firstAffected + fusion.affectedCount;
         ++i)
      if (std::uint8_t& label = h.affectedLabels[i]; label == 0 || label == near)
        label = static_cast<std::uint8_t>(near - label);
    fusion.level = h.levels - fusion.level;
    fusion.fused = vertexOf[birth.slot] = static_cast<VertexId>(h.points.size());
    out.order.fused[b] = fusion.fused;
    h.points.push_back(recorder.fusedPoints[b]);
  }
  out.order.baseVertices.assign(
      vertexOf.begin(),
      vertexOf.begin() + static_cast<std::ptrdiff_t>(out.order.baseBirths.size()));
  std::ranges::reverse(h.fusions);
}

/// From the last level's cells to those of the base mesh.
void fuseAll(FusionHistory& h) {
  for (const Fusion& fusion : h.fusions) {
    for (std::uint64_t i = fusion.firstAffected; i < fusion.firstAffected + fusion.affectedCount;
         ++i)
      std::ranges::replace(h.cells[h.affectedCells[i]], fusion.prey[h.affectedLabels[i]],
                           fusion.fused);
    for (std::uint64_t i = fusion.firstDeleted; i < fusion.firstDeleted + fusion.deletedCount; ++i)
      h.live[h.deletedCells[i]] = 0;
  }
}

/// The integers of the field's blocks: its values, or their differences to a prediction in time.
Result<std::vector<std::int32_t>> codedValues(const LogFile& log, const LogHistory& history,
                                              std::uint32_t field) {
  const std::uint32_t part = kFirstFieldPart + field;
  return decodeFieldBlocks(history.order, log.fields()[field], history.history.points.size(),
                           history.valueCodec,
                           [&](std::uint32_t chunk) { return log.checkedBlock(chunk, part); });
}

}  // namespace

Result<std::vector<std::int32_t>> historyValues(const LogFile& log, const LogHistory& history,
                                                std::uint32_t field) {
  assert(field < log.fields().size());
  std::map<std::uint32_t, std::vector<std::int32_t>> known;
  for (const std::uint32_t f : withParents(log.fields(), std::span(&field, 1))) {
    Result<std::vector<std::int32_t>> values = codedValues(log, history, f);
    if (!values) return std::unexpected(values.error());
    const TimePrediction& prediction = log.fields()[f].prediction;
    for (std::size_t i = 0; !prediction.isNone() && i < values->size(); ++i)
      if (std::int32_t& value = (*values)[i]; value != kMissing)
        value = restoreInTime(
            prediction, value, [&](std::uint16_t parent) { return known.at(parent)[i]; }, kMissing);
    known[f] = std::move(*values);
  }
  return std::move(known.at(field));
}

Result<LogHistory> historyOf(const LogFile& log, const std::function<void(double)>& progress) {
  const Result<Manifest> manifest = manifestOf(log.index());
  if (!manifest) return std::unexpected(manifest.error());
  LogHistory out;
  for (const ChunkEntry& e : log.chunks()) out.tetrahedra += e.newTetrahedra;
  Refiner refiner(log.index());
  SplitRecorder recorder(out);
  refiner.observe(&recorder);
  const auto chunks = static_cast<std::uint32_t>(log.chunks().size());
  for (std::uint32_t chunk = 0; chunk < chunks; ++chunk) {
    if (Status s = applyChunk(log, refiner, chunk, {}); !s) return std::unexpected(s.error());
    if (chunk == 0)
      if (Status s = decodeBase(log, out); !s) return std::unexpected(s.error());
    out.order.chunkBirths.push_back(static_cast<std::uint32_t>(out.order.points.births().size()));
    out.order.chunkCells.push_back(refiner.firstSlots(chunk + 1).tetrahedra);
    if (progress) progress((chunk + 1.0) / chunks);
  }
  out.order.tetrahedra.resize(out.tetrahedra);
  std::iota(out.order.tetrahedra.begin(), out.order.tetrahedra.end(), 0u);
  out.valueCodec = log.chunks().front().valueCodec;
  FusionHistory& h = out.history;
  h.lattice = {manifest->latticeBits, manifest->latticeStep, manifest->latticeOrigin};
  h.levels = refiner.level();
  out.vertices = static_cast<std::uint32_t>(refiner.points().size());
  h.points.assign(refiner.points().begin(), refiner.points().end());
  h.cells.assign(refiner.tetrahedra().begin(), refiner.tetrahedra().end());
  for (const Triangle& t : refiner.boundary()) h.cells.push_back({t[0], t[1], t[2], kGhost});
  h.live.assign(h.cells.size(), 1);
  number(recorder, out);
  fuseAll(h);
  return out;
}

}  // namespace qtet
