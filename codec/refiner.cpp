#include "codec/refiner.h"

#include <algorithm>
#include <string>

#include "codec/base_coder.h"
#include "codec/cell_values.h"
#include "codec/growing_mesh.h"
#include "codec/point_values.h"
#include "codec/record_coder.h"
#include "proto/checksum.h"
#include "proto/limits.h"

namespace qtet {
namespace {

constexpr const char* kCorrupt = "; the log is damaged or was not written by qtet: fetch or build it again";

std::unexpected<Error> refuse(ErrorCode code, std::uint32_t chunk, const std::string& what) {
  return fail(code, "chunk " + std::to_string(chunk) + ": " + what + (code == ErrorCode::kBadOrder ? "" : kCorrupt));
}

struct FieldState {
  std::vector<std::int32_t> values;
  std::uint32_t chunks = 0;
  bool broken = false;  // a block failed half-way: what it wrote is noise
};

}  // namespace

struct Refiner::State {
  LogIndex index;
  GrowingMesh mesh;
  Link link;
  Split inHand;
  RecordModels models;
  std::vector<BaseBirth> baseBirths;
  PointAncestry births;
  std::vector<std::size_t> chunkBirths;  // births before chunk i
  std::vector<std::size_t> chunkCells;   // tetrahedra before chunk i
  bool hasCellField = false;
  CellAncestry ancestry;  // kept where there is a cell field
  std::vector<FieldState> fields;
  std::vector<LevelCounts> levelCounts;
  std::uint32_t chunks = 0;
  std::uint32_t level = 0;       // being refined, or the last complete one
  std::uint32_t nextSlot = 0;    // of the level being refined
  bool inLevel = false;
  std::size_t levelBirths = 0;   // births before the level
  bool broken = false;
  std::uint32_t stopLevel = kMaxLevels + 1;
  bool stopped = false;          // inside a chunk, at stopLevel
  SplitObserver* observer = nullptr;

  Status base(const ChunkEntry& entry, ByteView structure, Values& positions);
  Status records(std::uint32_t chunk, const ChunkEntry& entry, ByteView structure, Values& positions);
  Status run(std::uint32_t chunk, const ChunkEntry& entry, RangeDecoder& decoder, Values& positions);
  Status split(std::uint32_t chunk, RecordCoder<RangeDecoder>& coder, VertexId v);
  Status counts(std::uint32_t chunk) const;
  void completeLevel() { levelCounts.push_back({mesh.points.size(), mesh.tetrahedra.size(), mesh.boundary.size()}); }
  void inherit(std::size_t field, std::uint32_t chunk);
  void inheritPoints(FieldState& field, std::uint32_t components, std::size_t firstBirth) const;
  void inheritCells(FieldState& field, const FieldShape& shape, std::size_t firstCell) const;
  void codePoints(FieldState& field, const FieldShape& shape, std::uint32_t chunk, Values& residuals) const;
  void codeCells(FieldState& field, const FieldShape& shape, std::uint32_t chunk, Values& residuals) const;

  struct Totals {
    std::uint64_t vertices = 0, tetrahedra = 0, triangles = 0, births = 0;
  } totals;  // as the table promises, up to and including the chunk in hand
};

Refiner::Refiner(LogIndex index) : state_(std::make_unique<State>()) {
  state_->fields.resize(index.fields.size());
  state_->hasCellField = index.hasCellField();
  state_->births = PointAncestry(std::ranges::any_of(index.fields, [](const FieldShape& f) { return f.association == Association::kPoint; }));
  state_->index = std::move(index);
  state_->chunkBirths.push_back(0);
  state_->chunkCells.push_back(0);
}
Refiner::~Refiner() = default;
Refiner::Refiner(Refiner&&) noexcept = default;
Refiner& Refiner::operator=(Refiner&&) noexcept = default;

Status Refiner::apply(std::uint32_t chunk, ByteView structure, std::span<const std::int32_t> positions) {
  State& s = *state_;
  if (s.broken) return refuse(ErrorCode::kBadOrder, chunk, "an earlier chunk failed; start again from chunk 0");
  if (s.index.layout != Layout::kStream) return refuse(ErrorCode::kBadVersion, chunk, "layout 'regions' needs a newer qtet");
  if (chunk >= s.index.chunks.size()) return refuse(ErrorCode::kBadOrder, chunk, "there is no such chunk");
  if (chunk != s.chunks) return refuse(ErrorCode::kBadOrder, chunk, "chunk " + std::to_string(s.chunks) + " has to be applied first");
  if (s.stopped || (chunk > 0 && level() >= s.stopLevel)) return refuse(ErrorCode::kBadOrder, chunk, "the refiner was told to stop at a level before it");
  const ChunkEntry& entry = s.index.chunks[chunk];
  if (positions.size() != std::size_t{s.index.tuples(chunk, kPositionsPart)} * 3) return refuse(ErrorCode::kBadValue, chunk, "wrong number of position values");

  s.broken = true;  // until the chunk has gone in whole
  s.totals.vertices += entry.newVertices;
  s.totals.tetrahedra += entry.newTetrahedra;
  s.totals.triangles += entry.newBoundaryTriangles;
  s.totals.births += entry.records;
  Values residuals(positions);
  const Status status = chunk == 0 ? s.base(entry, structure, residuals) : s.records(chunk, entry, structure, residuals);
  if (!status) return status;
  if (Status c = s.counts(chunk); !c && !s.stopped) return c;
  if (!residuals.atEnd() && !s.stopped) return refuse(ErrorCode::kBadValue, chunk, "position values are left over");
  s.chunkBirths.push_back(s.births.births().size());
  s.chunkCells.push_back(s.mesh.tetrahedra.size());
  for (std::size_t f = 0; f < s.fields.size(); ++f)
    if (s.fields[f].chunks > 0) s.inherit(f, chunk);
  ++s.chunks;
  s.broken = false;
  return {};
}

Status Refiner::State::base(const ChunkEntry& entry, ByteView structure, Values& positions) {
  RangeDecoder decoder(structure);
  BaseCoder<RangeDecoder> coder(decoder, entry.newVertices, entry.newTetrahedra);
  if (!coder.run(nullptr, [&] { return decoder.overrun(); }) || !decoder.atEnd())
    return refuse(ErrorCode::kBadValue, 0, "the base mesh's structure contradicts itself");
  baseBirths = std::move(coder.births);
  const std::int32_t size = std::int32_t{1} << index.positionBits;
  std::vector<LatticePoint> points;  // the mesh gets its cells once all of their vertices are there
  points.reserve(entry.newVertices);
  for (std::uint32_t v = 0; v < entry.newVertices; ++v) {
    LatticePoint p{};
    const auto at = [&](VertexId u, std::uint32_t c) { return points[u][c]; };
    for (std::uint32_t c = 0; c < 3; ++c) {
      p[c] = positions.code<false>(predictBase(baseBirths[v], v, c, true, at), 0);
      if (positions.bad() || p[c] < 0 || p[c] >= size) return refuse(ErrorCode::kBadValue, 0, "a vertex lies outside the lattice");
    }
    points.push_back(p);
  }
  mesh.points = std::move(points);
  mesh.tetrahedra = std::move(coder.tetrahedra);
  mesh.boundary = boundaryOf(mesh.tetrahedra);
  mesh.start(index.positionBits);
  if (hasCellField) ancestry.addBase(mesh.tetrahedra);
  completeLevel();
  return {};
}

Status Refiner::State::records(std::uint32_t chunk, const ChunkEntry& entry, ByteView structure, Values& positions) {
  RangeDecoder decoder(structure);
  if (Status s = run(chunk, entry, decoder, positions); !s) return s;
  if (!decoder.atEnd() && !stopped) return refuse(ErrorCode::kBadValue, chunk, "the structure block is longer or shorter than its records");
  return {};
}

Status Refiner::State::run(std::uint32_t chunk, const ChunkEntry& entry, RangeDecoder& decoder, Values& positions) {
  RecordCoder<RangeDecoder> coder(decoder, models, mesh, link, positions);
  if (entry.firstLevel != (inLevel ? level : level + 1)) return refuse(ErrorCode::kBadValue, chunk, "it does not continue the level before it");
  for (;;) {
    if (!inLevel) {
      ++level;
      nextSlot = 0;
      inLevel = true;
      levelBirths = births.births().size();
      mesh.beginLevel(level);
    }
    const std::uint32_t end = level == entry.lastLevel ? std::min(entry.endSlot, mesh.levelVertices()) : mesh.levelVertices();
    for (; nextSlot < end; ++nextSlot) {
      if (!mesh.maysplit(nextSlot)) continue;
      const bool splits = coder.splits(nextSlot, level, false);
      if (decoder.overrun()) return refuse(ErrorCode::kTruncated, chunk, "the structure block ends too early");
      if (!splits) continue;
      if (Status s = split(chunk, coder, nextSlot); !s) return s;
    }
    if (level == entry.lastLevel && entry.endSlot != kLevelEnd) return {};
    inLevel = false;
    if (births.births().size() == levelBirths) return refuse(ErrorCode::kBadValue, chunk, "a level without a record");
    completeLevel();
    if (level == entry.lastLevel) return {};
    if (level == stopLevel) {
      stopped = true;
      return {};
    }
  }
}

Status Refiner::State::split(std::uint32_t chunk, RecordCoder<RangeDecoder>& coder, VertexId v) {
  if (mesh.star(v).size() > kMaxLinkTriangles) return refuse(ErrorCode::kLimitExceeded, chunk, "a star has too many cells");
  if (!mesh.enter(v, link)) return refuse(ErrorCode::kBadValue, chunk, "a vertex splits whose link is not a sphere");
  Split& split = inHand;
  if (!coder.code(v, {}, split)) return refuse(ErrorCode::kBadValue, chunk, "a record's labels or positions contradict each other");
  const std::int32_t size = std::int32_t{1} << index.positionBits;
  for (int i = 0; i < split.k; ++i)
    for (const std::int32_t x : split.points[static_cast<std::size_t>(i)])
      if (x < 0 || x >= size) return refuse(ErrorCode::kBadValue, chunk, "a vertex lies outside the lattice");
  if (observer != nullptr) observer->beforeSplit(v, mesh, link, split);
  births.add(v, mesh, link, split);
  if (hasCellField) ancestry.addRestored(mesh.star(v), link, split.deleted);
  mesh.apply(v, link, split);
  if (mesh.points.size() > totals.vertices || mesh.tetrahedra.size() > totals.tetrahedra || mesh.boundary.size() > totals.triangles ||
      births.births().size() > totals.births)
    return counts(chunk);
  return {};
}

Status Refiner::State::counts(std::uint32_t chunk) const {
  if (mesh.points.size() == totals.vertices && mesh.tetrahedra.size() == totals.tetrahedra && mesh.boundary.size() == totals.triangles &&
      births.births().size() == totals.births)
    return {};
  return refuse(ErrorCode::kBadValue, chunk, "vertices, cells, triangles or records do not add up to the chunk table's counts");
}

// What chunk `chunk` brought carries a stand-in until the field's own block arrives: a cell its prediction, a vertex its fused vertex's value.
void Refiner::State::inherit(std::size_t field, std::uint32_t chunk) {
  const FieldShape shape = index.fields[field];
  if (shape.association == Association::kPoint)
    inheritPoints(fields[field], shape.components, chunkBirths[chunk]);
  else
    inheritCells(fields[field], shape, chunkCells[chunk]);
}

void Refiner::State::inheritCells(FieldState& field, const FieldShape& shape, std::size_t firstCell) const {
  const std::size_t n = shape.components;
  field.values.resize(mesh.tetrahedra.size() * n);
  for (std::size_t t = firstCell; t < mesh.tetrahedra.size(); ++t)
    for (std::size_t c = 0; c < n; ++c) {
      const auto at = [&](CellId u) { return field.values[u * n + c]; };
      const auto cell = static_cast<CellId>(t);
      field.values[t * n + c] = shape.gaps && ancestry.onlyGaps(cell, at) ? kGap : static_cast<std::int32_t>(ancestry.predict(cell, at));
    }
}

void Refiner::State::inheritPoints(FieldState& field, std::uint32_t components, std::size_t firstBirth) const {
  const std::size_t n = components;
  field.values.resize(mesh.points.size() * n);
  for (const Birth& b : births.births().subspan(firstBirth))
    for (std::size_t j = 0; j + 1 < b.k; ++j)
      for (std::size_t c = 0; c < n; ++c) field.values[(b.firstNew + j) * n + c] = field.values[b.slot * n + c];
}

Status Refiner::applyField(std::uint32_t field, std::uint32_t chunk, std::span<const std::int32_t> values) {
  State& s = *state_;
  if (field >= s.fields.size()) return refuse(ErrorCode::kNotFound, chunk, "there is no such field");
  FieldState& f = s.fields[field];
  if (f.broken) return refuse(ErrorCode::kBadOrder, chunk, "an earlier block of this field failed; start again from chunk 0");
  if (chunk != f.chunks) return refuse(ErrorCode::kBadOrder, chunk, "the field needs chunk " + std::to_string(f.chunks) + " first");
  if (chunk >= s.chunks) return refuse(ErrorCode::kBadOrder, chunk, "a field cannot run ahead of the mesh");
  const FieldShape shape = s.index.fields[field];
  if (values.size() != std::size_t{s.index.tuples(chunk, kFirstFieldPart + field)} * shape.components)
    return refuse(ErrorCode::kBadValue, chunk, "wrong number of field values");
  Values coded(values);
  if (shape.association == Association::kPoint)
    s.codePoints(f, shape, chunk, coded);
  else
    s.codeCells(f, shape, chunk, coded);
  const bool whole = coded.atEnd() || (s.stopped && chunk + 1 == s.chunks);
  f.broken = coded.bad() || !whole;
  if (f.broken) return refuse(ErrorCode::kBadValue, chunk, "field values out of range or left over");
  ++f.chunks;
  return {};
}

void Refiner::State::codePoints(FieldState& f, const FieldShape& shape, std::uint32_t chunk, Values& residuals) const {
  const std::uint32_t n = shape.components;
  if (chunk == 0) {
    f.values.assign(mesh.points.size() * n, 0);
    const auto at = [&](VertexId u, std::uint32_t c) { return f.values[std::size_t{u} * n + c]; };
    for (std::uint32_t v = 0; v < baseBirths.size(); ++v)
      for (std::uint32_t c = 0; c < n; ++c)
        f.values[std::size_t{v} * n + c] = residuals.codeField<false>(shape.gaps, predictBaseField(baseBirths[v], v, c, shape.gaps, at), 0);
    inheritPoints(f, n, 0);
  }
  const auto at = [&](VertexId v, std::uint32_t c) -> std::int32_t& { return f.values[std::size_t{v} * n + c]; };
  for (const Birth& b : births.births().subspan(chunkBirths[chunk], chunkBirths[chunk + 1] - chunkBirths[chunk]))
    births.code<false>(b, residuals, n, at, [](std::size_t, std::uint32_t) { return 0; }, shape.gaps);
}

void Refiner::State::codeCells(FieldState& f, const FieldShape& shape, std::uint32_t chunk, Values& residuals) const {
  const std::size_t n = shape.components;
  f.values.resize(mesh.tetrahedra.size() * n);
  for (std::size_t t = chunkCells[chunk]; t < chunkCells[chunk + 1]; ++t)
    for (std::size_t c = 0; c < n; ++c)
      f.values[t * n + c] =
          residuals.codeField<false>(shape.gaps, ancestry.predict(static_cast<CellId>(t), [&](CellId u) { return f.values[u * n + c]; }), 0);
  if (chunk == 0) inheritCells(f, shape, chunkCells[1]);
}

void Refiner::observe(SplitObserver* observer) { state_->observer = observer; }
void Refiner::stopAtLevel(std::uint32_t level) { state_->stopLevel = level; }

const LogIndex& Refiner::index() const { return state_->index; }
std::uint32_t Refiner::chunksApplied() const { return state_->chunks; }
std::uint32_t Refiner::fieldChunksApplied(std::uint32_t field) const { return state_->fields[field].chunks; }
std::uint32_t Refiner::level() const { return state_->inLevel ? state_->level - 1 : state_->level; }
std::span<const LevelCounts> Refiner::levelCounts() const { return state_->levelCounts; }
std::span<const LatticePoint> Refiner::points() const { return state_->mesh.points; }
std::span<const Tetrahedron> Refiner::tetrahedra() const { return state_->mesh.tetrahedra; }
std::span<const Triangle> Refiner::boundary() const { return state_->mesh.boundary; }
std::span<const std::int32_t> Refiner::fieldValues(std::uint32_t field) const { return state_->fields[field].values; }

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
