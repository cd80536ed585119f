// A refiner's chunks: the base mesh, the runs of levels of the head (all of `stream`), and the
// packets of `regions`.
#include <algorithm>

#include "codec/log/refiner_state.h"
#include "codec/mesh/boundary.h"

namespace qtet {
namespace {

// Stars are fetched so many vertices before they are read: one in twelve splits. 4 to 16 measured
// alike.
constexpr std::uint32_t kVerticesAhead = 8;

}  // namespace

Status Refiner::State::base(const ChunkEntry& entry, ByteView structure, Values& positions) {
  RangeDecoder decoder(structure);
  BaseCoder<RangeDecoder> coder(decoder, entry.newVertices, entry.newTetrahedra);
  if (!coder.run(nullptr, [&] { return decoder.overrun(); }))
    return refuseChunk(ErrorCode::kBadValue, 0, "the base mesh's structure contradicts itself");
  baseBirths = std::move(coder.births);
  const std::int32_t size = std::int32_t{1} << index.positionBits;
  std::vector<LatticePoint> points;  // the mesh gets its cells once all of their vertices are there
  points.reserve(entry.newVertices);
  for (std::uint32_t v = 0; v < entry.newVertices; ++v) {
    LatticePoint p{};
    const auto at = [&](VertexId u, std::uint32_t c) { return points[u][c]; };
    for (std::uint32_t c = 0; c < 3; ++c) {
      p[c] = positions.code<false>(predictBase(baseBirths[v], v, c, true, at), 0);
      if (positions.bad() || p[c] < 0 || p[c] >= size)
        return refuseChunk(ErrorCode::kBadValue, 0, "a vertex lies outside the lattice");
    }
    points.push_back(p);
  }
  mesh.points = std::move(points);
  mesh.tetrahedra = std::move(coder.tetrahedra);
  mesh.boundary = boundaryOf(mesh.tetrahedra);
  mesh.start(index.positionBits);
  if (hasCellField) ancestry.addBase(mesh.tetrahedra);
  completeLevel();
  if (Status s = endHead(0, decoder); !s) return s;
  return decoder.atEnd()
             ? Status{}
             : refuseChunk(ErrorCode::kBadValue, 0, "the base mesh's structure contradicts itself");
}

Status Refiner::State::records(std::uint32_t chunk, const ChunkEntry& entry, ByteView structure,
                               Values& positions) {
  RangeDecoder decoder(structure);
  if (Status s = run(chunk, entry, decoder, positions); !s) return s;
  if (stopped) {
    brought[chunk].cut = true;
    return {};
  }
  if (Status s = endHead(chunk, decoder); !s) return s;
  if (!decoder.atEnd())
    return refuseChunk(ErrorCode::kBadValue, chunk,
                       "the structure block is longer or shorter than its records");
  return {};
}

Status Refiner::State::run(std::uint32_t chunk, const ChunkEntry& entry, RangeDecoder& decoder,
                           Values& positions) {
  RecordCoder<RangeDecoder> coder(decoder, models.records, mesh, link, positions);
  if (entry.firstLevel != (inLevel ? level : level + 1))
    return refuseChunk(ErrorCode::kBadValue, chunk, "it does not continue the level before it");
  for (;;) {
    if (!inLevel) {
      if (Status s = mayGoOn(); !s) return s;
      ++level;
      nextSlot = 0;
      inLevel = true;
      levelBirths = births.births().size();
      mesh.beginLevel(level);
    }
    const std::uint32_t end = level == entry.lastLevel
                                  ? std::min(entry.endSlot, mesh.levelVertices())
                                  : mesh.levelVertices();
    for (; nextSlot < end; ++nextSlot) {
      mesh.expect(nextSlot + kVerticesAhead);
      if (!mesh.maysplit(nextSlot)) continue;
      const bool splits = coder.splits(nextSlot, level, false);
      if (decoder.overrun())
        return refuseChunk(ErrorCode::kTruncated, chunk, "the structure block ends too early");
      if (!splits) continue;
      if (Status s = split(chunk, coder, nextSlot); !s) return s;
    }
    if (level == entry.lastLevel && entry.endSlot != kLevelEnd) return {};
    inLevel = false;
    if (births.births().size() == levelBirths)
      return refuseChunk(ErrorCode::kBadValue, chunk, "a level without a record");
    completeLevel();
    if (level == entry.lastLevel) return {};
    if (level == stopLevel) {
      stopped = true;
      return {};
    }
  }
}

// The cells of the first packets' nodes: one bit after the other from the root down.
Status Refiner::State::endHead(std::uint32_t chunk, RangeDecoder& decoder) {
  if (chunk + 1 != headChunks || headChunks == index.chunks.size()) return {};
  NodeCells root;
  root.add({}, mesh.next());
  waiting[1] = std::move(root);
  for (std::uint32_t node = 1; node < 1u << firstDepth; ++node)
    if (Status s = children(chunk, node, std::exchange(waiting[node], {}), decoder); !s) return s;
  headModels = models;
  return {};
}

Status Refiner::State::children(std::uint32_t chunk, std::uint32_t node, const NodeCells& cells,
                                RangeDecoder& decoder) {
  ChildCoder<RangeDecoder> coder(decoder, models.children, mesh, index.positionBits, counts);
  std::array<NodeCells, 2> halves;
  if (!coder.code(cells, [](CellRef) { return 0; }, halves) || decoder.overrun())
    return refuseChunk(ErrorCode::kBadValue, chunk, "its child bits end too early or name no axis");
  for (std::uint32_t i = 0; i < 2; ++i) waiting[2 * node + i] = std::move(halves[i]);
  return {};
}

// Reads nothing that another packet of this band or a finer one could have changed: stars that lie
// in the node, and vertices beside them, which have cells of the node and so are split by its
// packets alone.
Status Refiner::State::packet(std::uint32_t chunk, const ChunkEntry& entry, ByteView structure,
                              Values& positions) {
  RangeDecoder decoder(structure);
  models = headModels;
  NodeCells cells = std::exchange(waiting[entry.node], {});
  mesh.continueAt(slots[chunk], slots[chunk + 1]);
  if (hasCellField) ancestry.makeRoom(slots[chunk + 1].tetrahedra);
  RecordCoder<RangeDecoder> coder(decoder, models.records, mesh, link, positions);
  std::vector<VertexId> inner = innerVertices(mesh, cells, counts);
  for (std::uint32_t l = entry.firstLevel; l <= std::min(entry.lastLevel, stopLevel); ++l)
    if (Status s = packetLevel(chunk, l, coder, decoder, inner); !s) return s;
  brought[chunk].cut = entry.lastLevel > stopLevel;
  if (!brought[chunk].cut) {
    cells.add(slots[chunk], mesh.next());
    if (2 * entry.node < waiting.size())
      if (Status s = children(chunk, entry.node, cells, decoder); !s) return s;
    if (!decoder.atEnd())
      return refuseChunk(ErrorCode::kBadValue, chunk,
                         "the structure block is longer or shorter than its records");
  }
  return endPacket(chunk, entry);
}

Status Refiner::State::packetLevel(std::uint32_t chunk, std::uint32_t atLevel,
                                   RecordCoder<RangeDecoder>& coder, RangeDecoder& decoder,
                                   std::vector<VertexId>& inner) {
  if (Status s = mayGoOn(); !s) return s;
  mesh.beginLevel(atLevel);
  const Slots before = mesh.next();
  const std::size_t vertices = inner.size();
  for (std::size_t i = 0; i < vertices; ++i) {
    if (!mesh.maysplit(inner[i])) continue;
    const bool splits = coder.splits(inner[i], atLevel, false);
    if (decoder.overrun())
      return refuseChunk(ErrorCode::kTruncated, chunk, "the structure block ends too early");
    if (!splits) continue;
    if (Status s = split(chunk, coder, inner[i]); !s) return s;
  }
  const Slots& after = mesh.next();
  // of a star in the node, so theirs are, too
  for (VertexId v = before.vertices; v < after.vertices; ++v) inner.push_back(v);
  added[atLevel].vertices += after.vertices - before.vertices;
  added[atLevel].tetrahedra += after.tetrahedra - before.tetrahedra;
  added[atLevel].boundaryTriangles += after.triangles - before.triangles;
  return {};
}

// Levels are complete once every packet of their band has come.
Status Refiner::State::endPacket(std::uint32_t chunk, const ChunkEntry& entry) {
  for (std::uint32_t l = entry.firstLevel; l <= std::min(entry.lastLevel, stopLevel); ++l)
    --missing[l];
  while (levelCounts.size() < missing.size() && levelCounts.size() <= stopLevel &&
         missing[levelCounts.size()] == 0) {
    const LevelCounts& more = added[levelCounts.size()];
    const LevelCounts& before = levelCounts.back();
    if (more.vertices == 0)
      return refuseChunk(ErrorCode::kBadValue, chunk, "a level without a record");
    levelCounts.push_back({before.vertices + more.vertices, before.tetrahedra + more.tetrahedra,
                           before.boundaryTriangles + more.boundaryTriangles});
  }
  return {};
}

Status Refiner::State::split(std::uint32_t chunk, RecordCoder<RangeDecoder>& coder, VertexId v) {
  if (mesh.star(v).size() > kMaxLinkTriangles)
    return refuseChunk(ErrorCode::kLimitExceeded, chunk, "a star has too many cells");
  if (!mesh.enter(v, link))
    return refuseChunk(ErrorCode::kBadValue, chunk, "a vertex splits whose link is not a sphere");
  Split& split = inHand;
  if (!coder.code(v, {}, split))
    return refuseChunk(ErrorCode::kBadValue, chunk,
                       "a record's labels or positions contradict each other");
  const std::int32_t size = std::int32_t{1} << index.positionBits;
  for (int i = 0; i < split.k; ++i)
    for (const std::int32_t x : split.points[static_cast<std::size_t>(i)])
      if (x < 0 || x >= size)
        return refuseChunk(ErrorCode::kBadValue, chunk, "a vertex lies outside the lattice");
  if (!mesh.slotsAfter(split, link).within(slots[chunk + 1]) ||
      births.births().size() - brought[chunk].firstBirth == index.chunks[chunk].records)
    return refuseChunk(
        ErrorCode::kBadValue, chunk,
        "it brings more vertices, cells, triangles or records than the chunk table says");
  if (observer != nullptr) observer->beforeSplit(v, mesh, link, split);
  births.add(v, mesh, link, split);
  if (hasCellField) ancestry.addRestored(mesh.star(v), link, split.deleted, mesh.next().tetrahedra);
  mesh.apply(v, link, split);
  return {};
}

Status Refiner::State::checkCounts(std::uint32_t chunk) const {
  if (mesh.next() == slots[chunk + 1] &&
      births.births().size() - brought[chunk].firstBirth == index.chunks[chunk].records)
    return {};
  return refuseChunk(
      ErrorCode::kBadValue, chunk,
      "vertices, cells, triangles or records do not add up to the chunk table's counts");
}

}  // namespace qtet
