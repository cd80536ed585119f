#include "codec/refine/refiner.h"

#include <algorithm>
#include <cassert>
#include <cstdlib>
#include <limits>
#include <string>
#include <utility>

#include "codec/refine/base_mesh.h"
#include "codec/refine/refiner_state.h"
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

PatchKind Refiner::State::kindOf(const LogIndex& index) {
  const bool mayHaveMore = index.unreadBytes() > 0;
  const bool hasPointFields = std::ranges::any_of(
      index.fields, [](const FieldShape& f) { return f.association == Association::kPoint; });
  return {index.positionBits, hasPointFields || mayHaveMore, index.hasCellField() || mayHaveMore};
}

Refiner::Refiner(const LogIndex& index) : state_(std::make_unique<State>(index)) {}
Refiner::~Refiner() = default;
Refiner::Refiner(Refiner&&) noexcept = default;
Refiner& Refiner::operator=(Refiner&&) noexcept = default;

Status Refiner::State::mayCome(std::uint32_t chunk) const {
  const auto refuse = [&](const std::string& what) {
    return refuseChunk(ErrorCode::kBadOrder, chunk, what);
  };
  if (phase == Phase::kBroken) return refuse("an earlier chunk failed; start again from chunk 0");
  if (chunk >= plan.index.chunks.size()) return refuse("there is no such chunk");
  if (chunk < added.size()) return refuse("it has been applied already");
  if (chunk > added.size())
    return refuse("chunk " + std::to_string(added.size()) + " has to be applied first");
  if (phase == Phase::kStopped || (chunk > 0 && mesh.level() >= requests.stopLevel))
    return refuse("the refiner was told to stop at a level before it");
  return {};
}

// Reserves memory for everything as soon as the bytes received make that credible; growing by
// doubling would hold up to three times as much. If the memory is not available, the mesh still
// grows as far as it can, since a reader may stop long before the end. Without exceptions a failed
// reserve() would end the program.
void Refiner::State::makeRoom(std::size_t bytes) {
  if (!structureBytes) return;
  *structureBytes += bytes;
  if (requests.stopLevel < plan.index.chunks.back().lastLevel) return;
  const Slots& total = plan.slots.back();
  if (std::max({total.vertices, total.tetrahedra, total.triangles}) >
      kMaxElementsPerByte * *structureBytes)
    return;
  structureBytes.reset();
  if (hasMemory(mesh.records().roomFor(total, plan.records)))
    mesh.records().makeRoom(total, plan.records);
}

Result<Extent> Refiner::State::readBase(PatchBlock& block) {
  if (Status s = mesh.records().work(block, block.entry.newTetrahedra); !s)
    return std::unexpected(s.error());
  Result<BaseMesh> base = decodeBaseMesh(block, plan.index.positionBits);
  if (!base) return std::unexpected(base.error());
  baseBirths = std::move(base->births);
  mesh.start(base->mesh);
  // whoever decodes the rest reads this chunk again, to its end
  if (!kBaseOnly && !block.decoder.atEnd()) return refuseBaseMesh(block);
  return Extent::kWhole;
}

Result<Extent> Refiner::State::readRun(PatchBlock& block) {
  if constexpr (kBaseOnly)
    return block.refuse(ErrorCode::kBadOrder, "this decoder reads the base mesh only");
  return mesh.read(block);
}

Status Refiner::State::apply(std::uint32_t chunk, ByteView structure, Values& positions) {
  const ChunkEntry& entry = plan.index.chunks[chunk];
  const std::size_t firstBirth = mesh.records().records();
  mesh.records().meter().grant(structure.size());
  PatchBlock block{chunk,
                   entry,
                   RangeDecoder(structure),
                   positions,
                   plan.slots[chunk + 1],
                   firstBirth + entry.records};
  const Result<Extent> extent = chunk == 0 ? readBase(block) : readRun(block);
  if (!extent) return std::unexpected(extent.error());
  if (*extent == Extent::kWhole) {
    if (Status s = mesh.records().checkCounts(block); !s) return s;
    if (!positions.atEnd())
      return refuseChunk(ErrorCode::kBadValue, chunk, "position values are left over");
  }
  added.push_back({*extent, firstBirth, mesh.records().records(), mesh.mesh().next().tetrahedra});
  fields.inherit(chunk);
  return {};
}

Status Refiner::apply(std::uint32_t chunk, ByteView structure,
                      std::span<const std::int32_t> positions) {
  State& s = *state_;
  if (Status order = s.mayCome(chunk); !order) return order;
  if (positions.size() != std::size_t{s.plan.index.tuples(chunk, kPositionsPart)} * 3)
    return refuseChunk(ErrorCode::kBadValue, chunk, "wrong number of position values");
  s.phase = State::Phase::kBroken;  // until the chunk has gone in whole
  s.makeRoom(structure.size());
  Values residuals(positions);
  if (Status status = s.apply(chunk, structure, residuals); !status) return status;
  s.phase =
      s.added[chunk].extent == Extent::kPartial ? State::Phase::kStopped : State::Phase::kOpen;
  return {};
}

Status Refiner::applyField(std::uint32_t field, std::uint32_t chunk,
                           std::span<const std::int32_t> values) {
  return state_->fields.apply(field, chunk, values);
}

Status Refiner::applyField(std::uint32_t field, std::uint32_t chunk, ByteView block) {
  return state_->fields.apply(field, chunk, block);
}

Status Refiner::readLater(ByteView part) {
  assert(index().unreadBytes() > 0);
  LogIndex index = state_->plan.index;
  if (Status s = index.readLater(part); !s) return s;
  state_->plan.index = std::move(index);
  state_->fields.planHasGrown();
  return {};
}

void Refiner::fieldsOnlyAt(Association association, std::span<const std::uint32_t> elements) {
  state_->fields.onlyAt(association, elements);
}

void Refiner::forgetField(std::uint32_t field) { state_->fields.forget(field); }

void Refiner::observe(SplitObserver* observer) { state_->requests.observer = observer; }
void Refiner::askBeforeLevels(LevelGate* gate) { state_->requests.gate = gate; }
void Refiner::stopAtLevel(std::uint32_t level) { state_->requests.stopLevel = level; }

const LogIndex& Refiner::index() const { return state_->plan.index; }
std::uint32_t Refiner::chunksApplied() const {
  return static_cast<std::uint32_t>(state_->added.size());
}
std::uint32_t Refiner::fieldChunksApplied(std::uint32_t field) const {
  return state_->fields.chunks(field);
}
const Slots& Refiner::firstSlots(std::uint32_t chunk) const {
  assert(chunk < state_->plan.slots.size());
  return state_->plan.slots[chunk];
}
std::uint32_t Refiner::level() const { return state_->mesh.level(); }
std::uint64_t Refiner::steps() const { return state_->mesh.records().meter().steps(); }
std::span<const LevelCounts> Refiner::levelCounts() const { return state_->mesh.levels(); }
std::span<const LatticePoint> Refiner::points() const { return state_->mesh.mesh().points; }
std::span<const Tetrahedron> Refiner::tetrahedra() const { return state_->mesh.mesh().tetrahedra; }
std::span<const Triangle> Refiner::boundary() const { return state_->mesh.mesh().boundary; }
std::optional<CellId> Refiner::across(CellId tetrahedron, std::size_t corner) const {
  return state_->mesh.mesh().across(tetrahedron, corner);
}
std::span<const std::int32_t> Refiner::fieldValues(std::uint32_t field) const {
  return state_->fields.values(field);
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
