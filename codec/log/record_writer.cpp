#include "codec/log/record_writer.h"

#include <algorithm>
#include <cassert>
#include <string>
#include <utility>

#include "codec/mesh/boundary.h"
#include "codec/record/base_coder.h"
#include "proto/limits.h"

namespace qtet {

RecordWriter::RecordWriter(const FusionHistory& history, CodecId valueCodec, std::stop_token stop)
    : history_(history),
      stop_(std::move(stop)),
      chunks_(valueCodec),
      mirror_(history),
      describer_(history, mirror_),
      estimate_(history),
      hasCellFields_(std::ranges::any_of(history.fields, isCellField)),
      coder_(chunks_.structure(), models_, mirror_.mesh(), link_, chunks_.positions()),
      added_(history.levels + 1u) {
  order_.points = PointAncestry(!std::ranges::all_of(history.fields, isCellField));
}

Status RecordWriter::base() {
  assert(mirror_.vertices().empty());
  std::vector<Tetrahedron> cells;
  std::vector<std::uint32_t> ids;
  for (std::uint32_t i = 0; i < history_.cells.size(); ++i)
    if (const auto& cell = history_.cells[i];
        history_.live[i] && std::ranges::find(cell, kGhost) == cell.end()) {
      cells.push_back(cell);
      ids.push_back(i);
    }
  std::vector<VertexId> used;
  for (const Tetrahedron& t : cells) used.insert(used.end(), t.begin(), t.end());
  std::ranges::sort(used);
  used.erase(std::ranges::unique(used).begin(), used.end());

  BaseTruth truth(cells);
  BaseCoder<RangeEncoder> coder(chunks_.structure(), static_cast<std::uint32_t>(used.size()),
                                static_cast<std::uint32_t>(cells.size()));
  const bool coded = coder.run(&truth, [this] { return stop_.stop_requested(); });
  if (stop_.stop_requested()) return cancelled();
  if (!coded)
    return fail(ErrorCode::kBadValue,
                "two cells of the base mesh disagree on the orientation of their face");
  std::vector<std::uint32_t> inOrder;
  for (const std::uint32_t i : coder.order) inOrder.push_back(ids[i]);
  CoarsePart base;
  for (const VertexId vertex : coder.vertexOrder) base.points.push_back(history_.points[vertex]);
  base.boundary = boundaryOf(coder.tetrahedra);
  base.tetrahedra = std::move(coder.tetrahedra);
  if (Status s = start(base, inOrder, coder.vertexOrder); !s) return s;
  const std::vector<LatticePoint>& points = mesh().points;
  const auto at = [&](VertexId u, std::uint32_t c) { return points[u][c]; };
  for (VertexId v = 0; v < points.size(); ++v)
    for (std::uint32_t c = 0; c < 3; ++c)
      chunks_.positions().code<true>(predictBase(coder.births[v], v, c, true, at), points[v][c]);
  order_.baseBirths = std::move(coder.births);
  order_.baseVertices = mirror_.vertices();
  if (hasCellFields_) order_.cells.addBase(mesh().tetrahedra);
  meter_.spend(mesh().tetrahedra.size());
  return {};
}

Status RecordWriter::patch(const CoarsePart& coarse, std::span<const std::uint32_t> cells,
                           std::span<const VertexId> vertices) {
  assert(history_.fields.empty());
  return start(coarse, cells, vertices);
}

Status RecordWriter::start(const CoarsePart& coarse, std::span<const std::uint32_t> cells,
                           std::span<const VertexId> vertices) {
  if (Status s = mirror_.start(coarse, cells, vertices); !s) return s;
  for (VertexId v = 0; v < mirror_.vertices().size(); ++v) describer_.place(v);
  added_[0] = mesh().next();
  return {};
}

Status RecordWriter::closeChunk(std::uint32_t lastLevel, std::uint32_t endSlot) {
  if (Status s = chunks_.close(lastLevel, endSlot, mesh().next()); !s) return s;
  order_.chunkBirths.push_back(static_cast<std::uint32_t>(order_.points.births().size()));
  order_.chunkCells.push_back(mesh().next().tetrahedra);
  meter_.grant(chunks_.rows().back().blocks[kStructurePart].size);
  if (!meter_.isExceeded()) return {};
  return fail(ErrorCode::kLimitExceeded,
              "too many levels of too few fusions, which readers refuse as too much work; simplify "
              "less (`targetRatio`)");
}

const ValueOrder& RecordWriter::order() {
  order_.tetrahedra = mirror_.tetrahedra();
  return order_;
}

const Fusion* RecordWriter::flag(VertexId v) {
  assert(mesh().maysplit(v));
  const Fusion* fusion = describer_.fusionAt(v);
  coder_.splits(v, mesh().level(), fusion != nullptr);
  meter_.spend(1 + (fusion != nullptr ? mesh().star(v).size() : 0));
  return fusion;
}

Status RecordWriter::record(VertexId v, Fusion fusion) {
  assert(mirror_.vertices()[v] == fusion.fused);
  if (stop_.stop_requested()) return cancelled();
  const auto bad = [&](const char* what) {
    return fail(ErrorCode::kBadValue,
                "fusion of vertex " + std::to_string(fusion.fused) + ": " + what);
  };
  if (mesh().star(v).size() > kMaxLinkTriangles) return bad("its star has too many cells");
  describer_.lookAhead(v);
  if (!mesh().enter(v, link_)) return bad("its link is not a closed surface");
  RecordTruth truth;
  if (!describer_.describe(v, link_, fusion, truth))
    return bad("the history's cells are not those of its star");
  Split split;
  if (!coder_.code(v, truth, split)) return bad("its cells cannot be described by labels");
  const Slots before = mesh().next();
  order_.points.add(v, mesh(), link_, split);
  if (hasCellFields_)
    order_.cells.addRestored(mesh().star(v), link_, split.deleted, before.tetrahedra);
  order_.prey.push_back(fusion.prey);
  order_.fused.push_back(fusion.fused);
  mirror_.apply(v, link_, split, fusion, describer_.restored(split));
  describer_.place(v);
  for (VertexId slot = before.vertices; slot < mesh().next().vertices; ++slot)
    describer_.place(slot);
  chunks_.endRecord(estimate_.bits(fusion, order_.cells, mirror_.tetrahedra(), before.tetrahedra));
  const Slots& after = mesh().next();
  Slots& level = added_[mesh().level()];
  level.vertices += after.vertices - before.vertices;
  level.tetrahedra += after.tetrahedra - before.tetrahedra;
  level.triangles += after.triangles - before.triangles;
  return {};
}

}  // namespace qtet
