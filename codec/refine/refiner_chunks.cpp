#include "codec/refine/refiner_chunks.h"

#include <algorithm>

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

Result<Extent> MeshReader::run(ChunkInput& chunk) {
  const ChunkEntry& entry = chunk.entry;
  if (entry.firstLevel != level() + 1)
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
    completeLevel();
    if (isLast) break;
    if (level == settings_.stopLevel) return Extent::kPartial;
  }
  return Extent::kWhole;
}

// Visits the level's vertices below `endSlot` that have not been visited yet.
Status MeshReader::visit(ChunkInput& chunk, RecordCoder<RangeDecoder>& coder,
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

void MeshReader::completeLevel() {
  const Slots mesh = records_.mesh().next();
  levels_.push_back({mesh.vertices, mesh.tetrahedra, mesh.triangles});
}

Status MeshReader::base(ChunkInput& chunk) {
  if (Status s = records_.base(chunk); !s) return s;
  completeLevel();
  return {};
}

Result<Extent> MeshReader::read(ChunkInput& chunk) {
  const bool isBase = chunk.number == 0;
  if constexpr (kBaseOnly) {
    if (!isBase) return chunk.refuse(ErrorCode::kBadOrder, "this decoder reads the base mesh only");
    if (Status s = base(chunk); !s) return std::unexpected(s.error());
    return Extent::kWhole;  // whoever decodes the rest reads this chunk again, to its end
  }
  if (isBase) {
    if (Status s = base(chunk); !s) return std::unexpected(s.error());
  } else {
    const Result<Extent> extent = run(chunk);
    if (!extent || *extent == Extent::kPartial) return extent;
  }
  if (!chunk.decoder.atEnd()) return isBase ? chunk.refuseBase() : chunk.refuseLength();
  return Extent::kWhole;
}

}  // namespace qtet
