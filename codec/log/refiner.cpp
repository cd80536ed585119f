#include "codec/log/refiner.h"

#include <algorithm>
#include <cstdlib>
#include <limits>

#include "codec/log/refiner_state.h"
#include "proto/checksum.h"

namespace qtet {

namespace {

// Whether so much can be had at once.
bool hasMemory(std::uint64_t bytes) {
  if (bytes > std::numeric_limits<std::size_t>::max() / 2) return false;
  // volatile: else compilers leave the call out
  void* volatile trial = std::malloc(static_cast<std::size_t>(bytes));
  std::free(trial);
  return trial != nullptr;
}

}  // namespace

std::unexpected<Error> refuseChunk(ErrorCode code, std::uint32_t chunk, const std::string& what) {
  constexpr const char* kCorrupt =
      "; the log is damaged or was not written by qtet: fetch or build it again";
  return fail(code, "chunk " + std::to_string(chunk) + ": " + what +
                        (code == ErrorCode::kBadOrder ? "" : kCorrupt));
}

Refiner::State::State(LogIndex logIndex)
    : index(std::move(logIndex)),
      headChunks(index.headChunks()),
      firstDepth(index.firstDepth()),
      lastDepth(index.lastDepth()) {
  births = PointAncestry(std::ranges::any_of(
      index.fields, [](const FieldShape& f) { return f.association == Association::kPoint; }));
  hasCellField = index.hasCellField();
  fields.resize(index.fields.size());
  for (Field& f : fields) f.applied.resize(index.chunks.size());
  brought.resize(index.chunks.size());
  slots.resize(1);
  for (const ChunkEntry& e : index.chunks) {
    const Slots& s = slots.back();
    slots.push_back({s.vertices + e.newVertices, s.tetrahedra + e.newTetrahedra,
                     s.triangles + e.newBoundaryTriangles});
  }
  if (headChunks == index.chunks.size()) return;
  waiting.resize(std::size_t{2} << lastDepth);
  added.resize(std::size_t{index.chunks.back().lastLevel} + 1);
  missing.resize(added.size());
  for (const ChunkEntry& e : index.chunks)
    for (std::uint32_t l = e.firstLevel; e.node != 0 && l <= e.lastLevel; ++l) ++missing[l];
}

Refiner::Refiner(LogIndex index) : state_(std::make_unique<State>(std::move(index))) {}
Refiner::~Refiner() = default;
Refiner::Refiner(Refiner&&) noexcept = default;
Refiner& Refiner::operator=(Refiner&&) noexcept = default;

Status Refiner::State::mayCome(std::uint32_t chunk) const {
  if (broken)
    return refuseChunk(ErrorCode::kBadOrder, chunk,
                       "an earlier chunk failed; start again from chunk 0");
  if (chunk >= index.chunks.size())
    return refuseChunk(ErrorCode::kBadOrder, chunk, "there is no such chunk");
  if (brought[chunk].applied)
    return refuseChunk(ErrorCode::kBadOrder, chunk, "it has been applied already");
  if (chunk > 0 && !brought[dependencyOf(chunk)].applied)
    return refuseChunk(ErrorCode::kBadOrder, chunk,
                       "chunk " + std::to_string(dependencyOf(chunk)) + " has to be applied first");
  const bool beyond = isPacket(chunk) ? index.chunks[chunk].firstLevel > stopLevel
                                      : chunk > 0 && lastLevel() >= stopLevel;
  if (stopped || beyond)
    return refuseChunk(ErrorCode::kBadOrder, chunk,
                       "the refiner was told to stop at a level before it");
  return {};
}

// Memory for everything at once, as soon as the bytes that came make it credible: growing by
// doubling would hold up to three times as much. Where that cannot be had, the mesh still grows as
// far as it goes: a reader may stop long before the end, and without exceptions a failed reserve()
// is the end.
void Refiner::State::makeRoom(std::size_t bytes) {
  structureBytes += bytes;
  if (roomy || stopLevel < index.chunks.back().lastLevel) return;
  const Slots& total = slots.back();
  if (std::max({total.vertices, total.tetrahedra, total.triangles}) >
      kMaxElementsPerPacketByte * structureBytes)
    return;
  roomy = true;
  std::uint64_t records = 0;
  for (const ChunkEntry& e : index.chunks) records += e.records;
  if (!hasMemory(GrowingMesh::roomFor(total) + births.roomFor(records, total.vertices))) return;
  mesh.reserve(total);
  births.reserve(records, total.vertices);
}

Status Refiner::apply(std::uint32_t chunk, ByteView structure,
                      std::span<const std::int32_t> positions) {
  State& s = *state_;
  if (Status order = s.mayCome(chunk); !order) return order;
  const ChunkEntry& entry = s.index.chunks[chunk];
  if (positions.size() != std::size_t{s.index.tuples(chunk, kPositionsPart)} * 3)
    return refuseChunk(ErrorCode::kBadValue, chunk, "wrong number of position values");

  s.broken = true;  // until the chunk has gone in whole
  s.makeRoom(structure.size());
  State::Brought& brought = s.brought[chunk];
  brought.firstBirth = s.births.births().size();
  Values residuals(positions);
  const Status status = chunk == 0          ? s.base(entry, structure, residuals)
                        : s.isPacket(chunk) ? s.packet(chunk, entry, structure, residuals)
                                            : s.records(chunk, entry, structure, residuals);
  if (!status) return status;
  if (Status c = s.checkCounts(chunk); !c && !brought.cut) return c;
  if (!residuals.atEnd() && !brought.cut)
    return refuseChunk(ErrorCode::kBadValue, chunk, "position values are left over");
  brought.applied = true;
  brought.endBirth = s.births.births().size();
  brought.end = s.mesh.next();
  for (std::size_t f = 0; f < s.fields.size(); ++f)
    if (s.fields[f].chunks > 0) s.inherit(s.fields[f], s.index.fields[f], chunk);
  ++s.chunks;
  s.broken = false;
  return {};
}

void Refiner::observe(SplitObserver* observer) { state_->observer = observer; }
void Refiner::askBeforeLevels(LevelGate* gate) { state_->gate = gate; }
void Refiner::stopAtLevel(std::uint32_t level) { state_->stopLevel = level; }

const LogIndex& Refiner::index() const { return state_->index; }
std::uint32_t Refiner::chunksApplied() const { return state_->chunks; }
std::uint32_t Refiner::fieldChunksApplied(std::uint32_t field) const {
  return state_->fields[field].chunks;
}
bool Refiner::applied(std::uint32_t chunk) const {
  return chunk < state_->brought.size() && state_->brought[chunk].applied;
}
bool Refiner::fieldApplied(std::uint32_t field, std::uint32_t chunk) const {
  return field < state_->fields.size() && chunk < state_->brought.size() &&
         state_->fields[field].applied[chunk];
}
const Slots& Refiner::firstSlots(std::uint32_t chunk) const { return state_->slots[chunk]; }
std::uint32_t Refiner::level() const { return state_->lastLevel(); }
std::span<const LevelCounts> Refiner::levelCounts() const { return state_->levelCounts; }
std::span<const LatticePoint> Refiner::points() const { return state_->mesh.points; }
std::span<const Tetrahedron> Refiner::tetrahedra() const { return state_->mesh.tetrahedra; }
std::span<const Triangle> Refiner::boundary() const { return state_->mesh.boundary; }
std::span<const std::int32_t> Refiner::fieldValues(std::uint32_t field) const {
  return state_->fields[field].values;
}

std::array<std::uint8_t, 32> Refiner::digest() const {
  Sha256 hash;
  const auto feed = [&hash](const auto& tuples) {
    ByteWriter w;
    for (const auto& tuple : tuples)
      for (const auto value : tuple) w.write(static_cast<std::uint32_t>(value));
    hash.update(w.bytes());
  };
  feed(points());
  feed(tetrahedra());
  feed(boundary());
  return hash.finish();
}

}  // namespace qtet
