#include "codec/refine/patch_records.h"

#include <cassert>

namespace qtet {
RecordReader::RecordReader(const PatchKind& kind, const PatchRequests& requests)
    : latticeSize_(std::int32_t{1} << kind.positionBits),
      positionBits_(kind.positionBits),
      requests_(requests) {
  ancestry_.points = PointAncestry(kind.hasPointFields);
  if (kind.hasCellFields) ancestry_.cells.emplace();
}

std::uint64_t RecordReader::roomFor(const Slots& total, std::uint64_t records) const {
  return GrowingMesh::roomFor(total) + ancestry_.points.roomFor(records, total.vertices);
}

void RecordReader::makeRoom(const Slots& total, std::uint64_t records) {
  mesh_.reserve(total);
  ancestry_.points.reserve(records, total.vertices);
}

void RecordReader::start(const CoarsePart& coarse) {
  assert(mesh_.points.empty());
  // not moved: makeRoom() may have reserved memory for all that is to come
  mesh_.points.assign(coarse.points.begin(), coarse.points.end());
  mesh_.tetrahedra.assign(coarse.tetrahedra.begin(), coarse.tetrahedra.end());
  mesh_.boundary.assign(coarse.boundary.begin(), coarse.boundary.end());
  mesh_.start(positionBits_, coarse.frozen);
  if (ancestry_.cells) ancestry_.cells->addBase(mesh_.tetrahedra);
}

Status RecordReader::work(const PatchBlock& chunk, std::uint64_t steps) {
  meter_.spend(steps);
  if (!meter_.isExceeded()) return {};
  return chunk.refuse(ErrorCode::kLimitExceeded,
                      "it takes more work than a log of so few bytes may ask for");
}

Status RecordReader::vertex(const PatchBlock& chunk, RecordCoder<RangeDecoder>& coder, VertexId v) {
  assert(mesh_.maysplit(v));
  const bool splits = coder.splits(v, mesh_.level(), false);
  if (chunk.decoder.overrun())
    return chunk.refuse(ErrorCode::kTruncated, "the structure block ends too early");
  if (Status s = work(chunk, 1 + (splits ? mesh_.star(v).size() : 0)); !s) return s;
  return splits ? split(chunk, coder, v) : Status{};
}

Status RecordReader::split(const PatchBlock& chunk, RecordCoder<RangeDecoder>& coder, VertexId v) {
  if (mesh_.star(v).size() > kMaxLinkTriangles)
    return chunk.refuse(ErrorCode::kLimitExceeded, "a star has too many cells");
  if (!mesh_.enter(v, link_))
    return chunk.refuse(ErrorCode::kBadValue, "a vertex splits whose link is not a sphere");
  Split& split = inHand_;
  if (!coder.code(v, {}, split))
    return chunk.refuse(ErrorCode::kBadValue,
                        "a record's labels or positions contradict each other");
  for (int i = 0; i < split.k; ++i)
    for (const std::int32_t x : split.points[static_cast<std::size_t>(i)])
      if (x < 0 || x >= latticeSize_)
        return chunk.refuse(ErrorCode::kBadValue, "a vertex lies outside the lattice");
  if (!mesh_.slotsAfter(split, link_).within(chunk.end) || records() == chunk.records)
    return chunk.refuse(
        ErrorCode::kBadValue,
        "it brings more vertices, cells, triangles or records than the chunk table says");
  if (requests_.observer != nullptr) requests_.observer->beforeSplit(v, mesh_, link_, split);
  ancestry_.points.add(v, mesh_, link_, split);
  if (ancestry_.cells)
    ancestry_.cells->addRestored(mesh_.star(v), link_, split.deleted, mesh_.next().tetrahedra);
  mesh_.apply(v, link_, split);
  return {};
}

Status RecordReader::checkCounts(const PatchBlock& chunk) const {
  if (mesh_.next() == chunk.end && records() == chunk.records) return {};
  return chunk.refuse(
      ErrorCode::kBadValue,
      "vertices, cells, triangles or records do not add up to the chunk table's counts");
}

}  // namespace qtet
