#include "codec/refine/refiner_chunks.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <utility>

#include "codec/log/log_index.h"

namespace qtet {
namespace {

// Stars are prefetched so many vertices ahead. One vertex in twelve splits. 4 to 16 measured alike.
constexpr std::uint32_t kVerticesAhead = 8;

// A page decodes the base mesh by a module without the rest, which is half as large (web-client).
#ifdef QTET_BASE_ONLY
constexpr bool kBaseOnly = true;
#else
constexpr bool kBaseOnly = false;
#endif

constexpr const char* kEmptyLevel = "a level without a record";

}  // namespace

// ---- levels

LevelProgress::LevelProgress(const ChunkPlan& plan) {
  if (!plan.hasPackets()) return;
  added_.resize(std::size_t{plan.index.chunks.back().lastLevel} + 1);
  missing_.resize(added_.size());
  for (const ChunkEntry& e : plan.index.chunks)
    for (std::uint32_t l = e.firstLevel; e.node != 0 && l <= e.lastLevel; ++l) ++missing_[l];
}

void LevelProgress::bring(std::uint32_t level, const Slots& before, const Slots& after) {
  added_[level].vertices += after.vertices - before.vertices;
  added_[level].tetrahedra += after.tetrahedra - before.tetrahedra;
  added_[level].boundaryTriangles += after.triangles - before.triangles;
}

bool LevelProgress::endPacket(std::uint32_t firstLevel, std::uint32_t lastLevel) {
  for (std::uint32_t l = firstLevel; l <= lastLevel; ++l) --missing_[l];
  while (complete_.size() < missing_.size() && missing_[complete_.size()] == 0) {
    const LevelCounts& more = added_[complete_.size()];
    const LevelCounts& before = complete_.back();
    if (more.vertices == 0) return false;
    complete_.push_back({before.vertices + more.vertices, before.tetrahedra + more.tetrahedra,
                         before.boundaryTriangles + more.boundaryTriangles});
  }
  return true;
}

// ---- the head

Result<Extent> HeadReader::read(ChunkInput& chunk) {
  const ChunkEntry& entry = chunk.entry;
  if (entry.firstLevel != levels_.last() + 1)
    return chunk.refuse(ErrorCode::kBadValue, "it does not continue the level before it");
  GrowingMesh& mesh = records_.mesh();
  RecordCoder<RangeDecoder> coder = records_.coderOf(chunk);
  for (std::uint32_t level = entry.firstLevel;; ++level) {
    if (Status s = records_.work(chunk, 1); !s) return std::unexpected(s.error());
    if (!open_) {
      if (Status s = settings_.mayGoOn(); !s) return std::unexpected(s.error());
      open_ = OpenLevel{0, records_.records()};
      mesh.beginLevel(level);
    }
    const bool isLast = level == entry.lastLevel;
    const std::uint32_t vertices = mesh.levelVertices();
    if (Status s = visit(chunk, coder, isLast ? std::min(entry.endSlot, vertices) : vertices); !s)
      return std::unexpected(s.error());
    if (isLast && entry.endSlot != kLevelEnd) break;
    if (records_.records() == open_->recordsBefore)
      return chunk.refuse(ErrorCode::kBadValue, kEmptyLevel);
    open_.reset();
    levels_.complete(mesh.next());
    if (isLast) break;
    if (level == settings_.stopLevel) return Extent::kPartial;
  }
  return Extent::kWhole;
}

// Visits the level's vertices below `endSlot` that have not been visited yet.
Status HeadReader::visit(ChunkInput& chunk, RecordCoder<RangeDecoder>& coder,
                         std::uint32_t endSlot) {
  const GrowingMesh& mesh = records_.mesh();
  for (VertexId v = open_->nextSlot; v < endSlot; ++v) {
    mesh.expect(v + kVerticesAhead);
    if (!mesh.maysplit(v)) continue;
    if (Status s = records_.vertex(chunk, coder, v); !s) return s;
  }
  open_->nextSlot = std::max(open_->nextSlot, endSlot);
  return {};
}

// ---- packets

PacketReader::PacketReader(const ChunkPlan& plan, const RefinerSettings& settings,
                           RecordReader& records, LevelProgress& levels)
    : plan_(plan),
      settings_(settings),
      records_(records),
      levels_(levels),
      waiting_(plan.hasPackets() ? std::size_t{2} << plan.lastDepth : 0) {}

// The cells of the first packets' nodes: one bit after the other from the root down.
Status PacketReader::endHead(ChunkInput& chunk) {
  assert(plan_.hasPackets());
  waiting_[1].add({}, records_.mesh().next());
  for (std::uint32_t node = 1; node < 1u << plan_.firstDepth; ++node)
    if (Status s = children(chunk, node, std::exchange(waiting_[node], {})); !s) return s;
  head_.records = records_.models();
  head_.children = models_;
  return {};
}

Status PacketReader::children(ChunkInput& chunk, std::uint32_t node, const NodeCells& cells) {
  ChildCoder<RangeDecoder> coder(chunk.decoder, models_, records_.mesh(), plan_.index.positionBits,
                                 counts_);
  std::array<NodeCells, 2> halves;
  if (Status s = records_.work(chunk, cells.size()); !s) return s;
  if (!coder.code(cells, [](CellRef) { return 0; }, halves) || chunk.decoder.overrun())
    return chunk.refuse(ErrorCode::kBadValue, "its child bits end too early or name no axis");
  for (std::uint32_t i = 0; i < 2; ++i) waiting_[2 * node + i] = std::move(halves[i]);
  return {};
}

// Reads nothing that another packet of this band or a finer one could have changed. It reads only
// stars that lie in the node, and vertices beside them. These have cells of the node, so only the
// node's packets split them.
Result<Extent> PacketReader::read(ChunkInput& packet) {
  const ChunkEntry& entry = packet.entry;
  records_.models() = head_.records;
  models_ = head_.children;
  NodeCells cells = std::exchange(waiting_[entry.node], {});
  records_.continueAt(packet);
  const GrowingMesh& mesh = records_.mesh();
  RecordCoder<RangeDecoder> coder = records_.coderOf(packet);
  std::vector<VertexId> inner = innerVertices(mesh, cells, counts_);
  const std::uint32_t lastLevel = std::min(entry.lastLevel, settings_.stopLevel);
  for (std::uint32_t l = entry.firstLevel; l <= lastLevel; ++l)
    if (Status s = level(packet, l, coder, inner); !s) return std::unexpected(s.error());
  const Extent extent = lastLevel < entry.lastLevel ? Extent::kPartial : Extent::kWhole;
  if (extent == Extent::kWhole) {
    cells.add(packet.first, mesh.next());
    if (2 * entry.node < waiting_.size())
      if (Status s = children(packet, entry.node, cells); !s) return std::unexpected(s.error());
    if (!packet.decoder.atEnd()) return packet.refuseLength();
  }
  if (!levels_.endPacket(entry.firstLevel, lastLevel))
    return packet.refuse(ErrorCode::kBadValue, kEmptyLevel);
  return extent;
}

Status PacketReader::level(ChunkInput& packet, std::uint32_t level,
                           RecordCoder<RangeDecoder>& coder, std::vector<VertexId>& inner) {
  if (Status s = settings_.mayGoOn(); !s) return s;
  if (Status s = records_.work(packet, 1); !s) return s;
  GrowingMesh& mesh = records_.mesh();
  mesh.beginLevel(level);
  const Slots before = mesh.next();
  const std::size_t vertices = inner.size();
  for (std::size_t i = 0; i < vertices; ++i) {
    if (!mesh.maysplit(inner[i])) continue;
    if (Status s = records_.vertex(packet, coder, inner[i]); !s) return s;
  }
  // of a star in the node, so theirs are, too
  for (VertexId v = before.vertices; v < mesh.next().vertices; ++v) inner.push_back(v);
  levels_.bring(level, before, mesh.next());
  return {};
}

// ---- all three

Status MeshReader::base(ChunkInput& chunk) {
  if (Status s = records_.base(chunk); !s) return s;
  levels_.complete(records_.mesh().next());
  return {};
}

Result<Extent> MeshReader::read(ChunkInput& chunk) {
  const bool isBase = chunk.number == 0;
  if constexpr (kBaseOnly) {
    if (!isBase) return chunk.refuse(ErrorCode::kBadOrder, "this decoder reads the base mesh only");
    if (Status s = base(chunk); !s) return std::unexpected(s.error());
    return Extent::kWhole;  // whoever decodes the rest reads this chunk again, to its end
  }
  if (plan_.isPacket(chunk.number)) return packets_.read(chunk);
  if (isBase) {
    if (Status s = base(chunk); !s) return std::unexpected(s.error());
  } else {
    const Result<Extent> extent = head_.read(chunk);
    if (!extent || *extent == Extent::kPartial) return extent;
  }
  if (chunk.number + 1 == plan_.headChunks && plan_.hasPackets())
    if (Status s = packets_.endHead(chunk); !s) return std::unexpected(s.error());
  if (!chunk.decoder.atEnd()) return isBase ? chunk.refuseBase() : chunk.refuseLength();
  return Extent::kWhole;
}

}  // namespace qtet
