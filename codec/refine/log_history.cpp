#include "codec/refine/log_history.h"

#include <algorithm>
#include <map>
#include <string>
#include <type_traits>
#include <utility>

#include "codec/log/log_manifest.h"
#include "codec/log/value_block.h"
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
    out_.points.add(v, mesh, link, split);
    out_.cells.addRestored(mesh.star(v), link, split.deleted, mesh.next().tetrahedra);
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
  out.baseBirths = std::move(coder.births);
  out.cells.addBase(coder.tetrahedra);
  return {};
}

/// Gives every split's vertices their numbers in the history. Sorts the fusions in the order of
/// execution: from the last split to the first.
void number(const SplitRecorder& recorder, LogHistory& out) {
  FusionHistory& h = out.history;
  std::vector<VertexId> vertexOf(out.vertices);  // slot -> the vertex that is there
  for (VertexId v = 0; v < out.vertices; ++v) vertexOf[v] = v;
  out.prey.resize(h.fusions.size());
  for (std::size_t b = h.fusions.size(); b-- > 0;) {
    Fusion& fusion = h.fusions[b];
    const Birth& birth = out.points.births()[b];
    std::array<VertexId, 4>& prey = out.prey[b];
    for (std::size_t i = 0; i < birth.k; ++i)
      prey[i] = vertexOf[i == 0 ? birth.slot : birth.firstNew + i - 1];
    fusion.prey = prey;
    const std::uint8_t near = recorder.near[b];
    std::swap(fusion.prey[0], fusion.prey[near]);
    for (std::uint64_t i = fusion.firstAffected; i < fusion.firstAffected + fusion.affectedCount;
         ++i)
      if (std::uint8_t& label = h.affectedLabels[i]; label == 0 || label == near)
        label = static_cast<std::uint8_t>(near - label);
    fusion.level = h.levels - fusion.level;
    fusion.fused = vertexOf[birth.slot] = static_cast<VertexId>(h.points.size());
    h.points.push_back(recorder.fusedPoints[b]);
  }
  out.baseVertices.assign(vertexOf.begin(),
                          vertexOf.begin() + static_cast<std::ptrdiff_t>(out.baseBirths.size()));
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

/// The history's integers of a field, `components` a vertex or tetrahedron: an encoder reads them,
/// a decoder writes them.
template <bool kEncoding>
struct HistoryField {
  std::uint32_t components;
  bool hasMissing;
  std::span<std::conditional_t<kEncoding, const std::int32_t, std::int32_t>> values;
};

/// `now`: the values by slot. A decoder notes a fused vertex's just before it splits; those of the
/// last level are left in `now`.
template <bool kEncoding>
void codePoints(const LogHistory& log, std::uint32_t chunk, const HistoryField<kEncoding>& field,
                std::vector<std::int32_t>& now, Values& coded) {
  const std::size_t n = field.components;
  const auto at = [&](VertexId v, std::uint32_t c) -> std::int32_t& { return now[v * n + c]; };
  const auto truth = [&](VertexId v, std::uint32_t c) { return field.values[v * n + c]; };
  if (chunk == 0)
    for (VertexId v = 0; v < log.baseBirths.size(); ++v)
      for (std::uint32_t c = 0; c < n; ++c)
        at(v, c) = coded.codeField<kEncoding>(
            field.hasMissing, predictBaseField(log.baseBirths[v], v, c, field.hasMissing, at),
            truth(log.baseVertices[v], c));
  const std::vector<Fusion>& fusions = log.history.fusions;
  for (std::uint32_t b = log.chunkBirths[chunk]; b < log.chunkBirths[chunk + 1]; ++b) {
    const Birth& birth = log.points.births()[b];
    if constexpr (!kEncoding) {
      const VertexId fused = fusions[fusions.size() - 1 - b].fused;
      for (std::uint32_t c = 0; c < n; ++c) field.values[fused * n + c] = at(birth.slot, c);
    }
    log.points.code<kEncoding>(
        birth, coded, field.components, at,
        [&](std::size_t i, std::uint32_t c) { return truth(log.prey[b][i], c); }, field.hasMissing);
  }
}

template <bool kEncoding>
void codeCells(const LogHistory& log, std::uint32_t chunk, const HistoryField<kEncoding>& field,
               Values& coded) {
  const std::size_t n = field.components;
  for (CellId t = log.chunkCells[chunk]; t < log.chunkCells[chunk + 1]; ++t)
    for (std::uint32_t c = 0; c < n; ++c) {
      const auto at = [&](CellId u) { return field.values[u * n + c]; };
      const std::int32_t value =
          coded.codeField<kEncoding>(field.hasMissing, log.cells.predict(t, at), at(t));
      if constexpr (!kEncoding) field.values[t * n + c] = value;
    }
}

/// The integers of the field's blocks: its values, or their differences to a prediction in time.
Result<std::vector<std::int32_t>> codedValues(const LogFile& log, const LogHistory& history,
                                              std::uint32_t field) {
  const FieldShape& shape = log.fields()[field];
  const bool ofCells = shape.association == Association::kCell;
  const std::size_t elements = ofCells ? history.tetrahedra : history.history.points.size();
  std::vector<std::int32_t> out(elements * shape.components);
  const HistoryField<false> coded{shape.components, shape.hasMissing, out};
  std::vector<std::int32_t> now(ofCells ? 0 : std::size_t{history.vertices} * shape.components);
  for (std::uint32_t chunk = 0; chunk < log.chunks().size(); ++chunk) {
    const auto block = log.values(chunk, kFirstFieldPart + field);
    if (!block) return std::unexpected(block.error());
    Values in(*block);
    if (ofCells)
      codeCells(history, chunk, coded, in);
    else
      codePoints(history, chunk, coded, now, in);
    if (in.bad() || !in.atEnd())
      return refuseChunk(ErrorCode::kBadValue, chunk, "field values out of range or left over");
  }
  std::ranges::copy(now, out.begin());  // the last level's vertices come first
  return out;
}

}  // namespace

Result<std::vector<std::int32_t>> historyValues(const LogFile& log, const LogHistory& history,
                                                std::uint32_t field) {
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
  out.chunkBirths.push_back(0);
  out.chunkCells.push_back(0);
  const auto chunks = static_cast<std::uint32_t>(log.chunks().size());
  for (std::uint32_t chunk = 0; chunk < chunks; ++chunk) {
    if (Status s = applyChunk(log, refiner, chunk, {}); !s) return std::unexpected(s.error());
    if (chunk == 0)
      if (Status s = decodeBase(log, out); !s) return std::unexpected(s.error());
    out.chunkBirths.push_back(static_cast<std::uint32_t>(out.points.births().size()));
    out.chunkCells.push_back(refiner.firstSlots(chunk + 1).tetrahedra);
    out.valueCodecs.push_back(log.chunks()[chunk].valueCodec);
    if (progress) progress((chunk + 1.0) / chunks);
  }
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

Result<std::vector<Bytes>> encodeFieldBlocks(const LogHistory& log, const FieldInfo& field,
                                             std::span<const std::int32_t> values) {
  std::vector<Bytes> out;
  const HistoryField<true> truth{field.components, field.hasMissing, values};
  std::vector<std::int32_t> now(isCellField(field) ? 0
                                                   : std::size_t{log.vertices} * field.components);
  for (std::uint32_t chunk = 0; chunk + 1 < log.chunkBirths.size(); ++chunk) {
    Values coded;
    if (isCellField(field))
      codeCells(log, chunk, truth, coded);
    else
      codePoints(log, chunk, truth, now, coded);
    Result<Bytes> block =
        encodeValueBlock(coded.written(), field.components, log.valueCodecs[chunk]);
    if (!block) return std::unexpected(block.error());
    out.push_back(std::move(*block));
  }
  return out;
}

}  // namespace qtet
