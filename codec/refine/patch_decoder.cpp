#include "codec/refine/patch_decoder.h"

#include <algorithm>

namespace qtet {
namespace {

// Stars are prefetched so many vertices ahead. One vertex in twelve splits. 4 to 16 measured alike.
constexpr std::uint32_t kVerticesAhead = 8;

constexpr const char* kEmptyLevel = "a level without a record";

}  // namespace

Result<Extent> PatchDecoder::run(PatchBlock& chunk) {
  const ChunkEntry& entry = chunk.entry;
  if (entry.firstLevel != level() + 1)
    return chunk.refuse(ErrorCode::kBadValue, "it does not continue the level before it");
  GrowingMesh& mesh = records_.mesh();
  RecordCoder<RangeDecoder> coder = records_.coderOf(chunk);
  for (std::uint32_t level = entry.firstLevel;; ++level) {
    if (Status s = records_.work(chunk, 1); !s) return std::unexpected(s.error());
    if (!open_) {
      if (Status s = requests_.mayGoOn(); !s) return std::unexpected(s.error());
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
    if (level == requests_.stopLevel) return Extent::kPartial;
  }
  return Extent::kWhole;
}

// Visits the level's vertices below `endSlot` that have not been visited yet.
Status PatchDecoder::visit(PatchBlock& chunk, RecordCoder<RangeDecoder>& coder,
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

void PatchDecoder::completeLevel() {
  const Slots mesh = records_.mesh().next();
  levels_.push_back({mesh.vertices, mesh.tetrahedra, mesh.triangles});
}

void PatchDecoder::start(const CoarsePart& coarse) {
  records_.start(coarse);
  completeLevel();
}

Result<Extent> PatchDecoder::read(PatchBlock& chunk) {
  const Result<Extent> extent = run(chunk);
  if (!extent || *extent == Extent::kPartial) return extent;
  if (chunk.decoder.atEnd()) return Extent::kWhole;
  return chunk.refuse(ErrorCode::kBadValue,
                      "the structure block is longer or shorter than its records");
}

}  // namespace qtet
