#include "codec/refine/refiner_records.h"

#include <algorithm>
#include <cassert>
#include <utility>

#include "codec/mesh/boundary.h"

namespace qtet {
namespace {

constexpr const char* kOutside = "a vertex lies outside the lattice";

}  // namespace

std::unexpected<Error> ChunkInput::refuseLength() const {
  return refuse(ErrorCode::kBadValue, "the structure block is longer or shorter than its records");
}

std::unexpected<Error> ChunkInput::refuseBase() const {
  return refuse(ErrorCode::kBadValue, "the base mesh's structure contradicts itself");
}

ChunkPlan::ChunkPlan(LogIndex logIndex) : index(std::move(logIndex)), slots(1) {
  for (const ChunkEntry& e : index.chunks) {
    const Slots& s = slots.back();
    slots.push_back({s.vertices + e.newVertices, s.tetrahedra + e.newTetrahedra,
                     s.triangles + e.newBoundaryTriangles});
  }
}

RecordReader::RecordReader(const ChunkPlan& plan, const RefinerSettings& settings)
    : plan_(plan), settings_(settings) {
  ancestry_.points = PointAncestry(std::ranges::any_of(
      plan.index.fields, [](const FieldShape& f) { return f.association == Association::kPoint; }));
  if (plan.index.hasCellField()) ancestry_.cells.emplace();
}

std::uint64_t RecordReader::recordsOfAll() const {
  std::uint64_t records = 0;
  for (const ChunkEntry& e : plan_.index.chunks) records += e.records;
  return records;
}

std::uint64_t RecordReader::roomForAll() const {
  const Slots& total = plan_.slots.back();
  return GrowingMesh::roomFor(total) + ancestry_.points.roomFor(recordsOfAll(), total.vertices);
}

void RecordReader::makeRoomForAll() {
  const Slots& total = plan_.slots.back();
  mesh_.reserve(total);
  ancestry_.points.reserve(recordsOfAll(), total.vertices);
}

Status RecordReader::work(const ChunkInput& chunk, std::uint64_t steps) {
  meter_.spend(steps);
  if (!meter_.isExceeded()) return {};
  return chunk.refuse(ErrorCode::kLimitExceeded,
                      "it takes more work than a log of so few bytes may ask for");
}

Status RecordReader::base(ChunkInput& chunk) {
  assert(mesh_.points.empty());
  if (Status s = work(chunk, chunk.entry.newTetrahedra); !s) return s;
  BaseCoder<RangeDecoder> coder(chunk.decoder, chunk.entry.newVertices, chunk.entry.newTetrahedra);
  if (!coder.run(nullptr, [&] { return chunk.decoder.overrun(); })) return chunk.refuseBase();
  ancestry_.base = std::move(coder.births);
  const std::int32_t size = std::int32_t{1} << plan_.index.positionBits;
  std::vector<LatticePoint> points;  // the mesh gets its cells once all of their vertices are there
  points.reserve(chunk.entry.newVertices);
  for (std::uint32_t v = 0; v < chunk.entry.newVertices; ++v) {
    LatticePoint p{};
    const auto at = [&](VertexId u, std::uint32_t c) { return points[u][c]; };
    for (std::uint32_t c = 0; c < 3; ++c) {
      p[c] = chunk.positions.code<false>(predictBase(ancestry_.base[v], v, c, true, at), 0);
      if (chunk.positions.bad() || p[c] < 0 || p[c] >= size)
        return chunk.refuse(ErrorCode::kBadValue, kOutside);
    }
    points.push_back(p);
  }
  mesh_.points = std::move(points);
  mesh_.tetrahedra = std::move(coder.tetrahedra);
  mesh_.boundary = boundaryOf(mesh_.tetrahedra);
  mesh_.start(plan_.index.positionBits);
  if (ancestry_.cells) ancestry_.cells->addBase(mesh_.tetrahedra);
  return {};
}

Status RecordReader::vertex(const ChunkInput& chunk, RecordCoder<RangeDecoder>& coder, VertexId v) {
  assert(mesh_.maysplit(v));
  const bool splits = coder.splits(v, mesh_.level(), false);
  if (chunk.decoder.overrun())
    return chunk.refuse(ErrorCode::kTruncated, "the structure block ends too early");
  if (Status s = work(chunk, 1 + (splits ? mesh_.star(v).size() : 0)); !s) return s;
  return splits ? split(chunk, coder, v) : Status{};
}

Status RecordReader::split(const ChunkInput& chunk, RecordCoder<RangeDecoder>& coder, VertexId v) {
  if (mesh_.star(v).size() > kMaxLinkTriangles)
    return chunk.refuse(ErrorCode::kLimitExceeded, "a star has too many cells");
  if (!mesh_.enter(v, link_))
    return chunk.refuse(ErrorCode::kBadValue, "a vertex splits whose link is not a sphere");
  Split& split = inHand_;
  if (!coder.code(v, {}, split))
    return chunk.refuse(ErrorCode::kBadValue,
                        "a record's labels or positions contradict each other");
  const std::int32_t size = std::int32_t{1} << plan_.index.positionBits;
  for (int i = 0; i < split.k; ++i)
    for (const std::int32_t x : split.points[static_cast<std::size_t>(i)])
      if (x < 0 || x >= size) return chunk.refuse(ErrorCode::kBadValue, kOutside);
  if (!mesh_.slotsAfter(split, link_).within(chunk.end) || records() == chunk.records)
    return chunk.refuse(
        ErrorCode::kBadValue,
        "it brings more vertices, cells, triangles or records than the chunk table says");
  if (settings_.observer != nullptr) settings_.observer->beforeSplit(v, mesh_, link_, split);
  ancestry_.points.add(v, mesh_, link_, split);
  if (ancestry_.cells)
    ancestry_.cells->addRestored(mesh_.star(v), link_, split.deleted, mesh_.next().tetrahedra);
  mesh_.apply(v, link_, split);
  return {};
}

Status RecordReader::checkCounts(const ChunkInput& chunk) const {
  if (mesh_.next() == chunk.end && records() == chunk.records) return {};
  return chunk.refuse(
      ErrorCode::kBadValue,
      "vertices, cells, triangles or records do not add up to the chunk table's counts");
}

}  // namespace qtet
