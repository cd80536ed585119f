#include "codec/log_writer.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <optional>
#include <string>

#include "codec/base_coder.h"
#include "codec/cell_values.h"
#include "codec/value_block.h"
#include "codec/growing_mesh.h"
#include "codec/log_index.h"
#include "codec/log_manifest.h"
#include "codec/point_values.h"
#include "codec/record_coder.h"
#include "proto/crc32c.h"
#include "proto/limits.h"

namespace qtet {
namespace {

constexpr std::uint32_t kNone = 0xFFFFFFFFu;

// A picture sharpens when a chunk is whole, so that each is a share of what a viewer has already waited for, up to LogWriterOptions::chunkBytes. Smaller
// ones cost more than they give: a row of the table and Draco's fixed bytes are 130 bytes a chunk with one field, 3 % of 4 KB.
constexpr std::uint64_t kLeastChunkBytes = 4 << 10;
constexpr std::uint64_t kGrowth = 4;

/// A chunk under construction.
struct OpenChunk {
  ChunkEntry entry;
  Values positions;
  std::vector<Values> fields;
  std::uint64_t valueBits = 0;  // estimate of what the values will take
};

class LogEncoder {
 public:
  LogEncoder(const FusionHistory& history, const LogWriterOptions& options) : h_(history), options_(options) {}

  Result<EncodedLog> run() {
    if (Status s = prepare(); !s) return std::unexpected(s.error());
    if (Status s = base(); !s) return std::unexpected(s.error());
    for (std::uint32_t level = 1; level <= h_.levels; ++level) {
      if (Status s = encodeLevel(level); !s) return std::unexpected(s.error());
      addLevel(level);
      if (options_.progress) options_.progress(static_cast<double>(mesh_.tetrahedra.size()) / static_cast<double>(h_.cells.size()));
    }
    if (open_.entry.records > 0 || open_.entry.firstLevel != 0)
      if (Status s = closeChunk(h_.levels, kLevelEnd); !s) return std::unexpected(s.error());
    return assemble();
  }

 private:
  Status prepare() {
    if (h_.levels > kMaxLevels) return fail(ErrorCode::kLimitExceeded, "more than 4,096 levels");
    if (!options_.errors.empty() && options_.errors.size() != h_.levels + 1u)
      return fail(ErrorCode::kBadValue, "there are known errors of " + std::to_string(options_.errors.size()) + " levels, but " +
                                            std::to_string(h_.levels + 1u) + " levels; measure the history that is encoded");
    if (h_.fields.size() > kMaxFields) return fail(ErrorCode::kLimitExceeded, "more than 256 fields; choose some with --fields");
    if (h_.points.size() > kMaxElements || h_.cells.size() > kMaxElements) return fail(ErrorCode::kLimitExceeded, "more than 2^29 cells");
    fusionOf_.assign(h_.points.size(), kNone);
    for (std::uint32_t i = 0; i < h_.fusions.size(); ++i) fusionOf_[h_.fusions[i].fused] = i;
    slotOf_.assign(h_.points.size(), kNone);
    labelOf_.assign(h_.cells.size(), kNoLabel);
    values_.resize(h_.fields.size());
    open_.fields.resize(h_.fields.size());
    hasCellField_ = std::ranges::any_of(h_.fields, isCellField);
    pointAncestry_ = PointAncestry(!std::ranges::all_of(h_.fields, isCellField));
    const auto ghosts = std::ranges::count_if(h_.cells, [](const auto& c) { return std::ranges::find(c, kGhost) != c.end(); });
    const std::size_t tetrahedra = h_.cells.size() - static_cast<std::size_t>(ghosts);
    for (std::size_t f = 0; f < h_.fields.size(); ++f)
      if (isCellField(h_.fields[f]) && h_.values[f].size() != tetrahedra * h_.fields[f].components)
        return fail(ErrorCode::kBadValue, "cell field " + h_.fields[f].name + " has " + std::to_string(h_.values[f].size()) + " numbers for " +
                                              std::to_string(tetrahedra) + " tetrahedra");
    return {};
  }

  [[nodiscard]] std::uint32_t levelOf(const Fusion& f) const { return h_.levels - f.level; }

  Status base() {
    std::vector<Tetrahedron> cells;
    std::vector<std::uint32_t> ids;
    for (std::uint32_t i = 0; i < h_.cells.size(); ++i)
      if (h_.live[i] && std::ranges::find(h_.cells[i], kGhost) == h_.cells[i].end()) cells.push_back(h_.cells[i]), ids.push_back(i);
    std::vector<VertexId> used;
    for (const Tetrahedron& t : cells) used.insert(used.end(), t.begin(), t.end());
    std::ranges::sort(used);
    used.erase(std::ranges::unique(used).begin(), used.end());

    BaseTruth truth(cells);
    BaseCoder<RangeEncoder> coder(range_, static_cast<std::uint32_t>(used.size()), static_cast<std::uint32_t>(cells.size()));
    if (!coder.run(&truth, [] { return false; })) return fail(ErrorCode::kBadValue, "two cells of the base mesh disagree on the orientation of their face");
    mesh_.tetrahedra = std::move(coder.tetrahedra);
    for (const std::uint32_t i : coder.order) tetrahedronIds_.push_back(ids[i]);
    vertexIds_ = std::move(coder.vertexOrder);
    for (std::uint32_t v = 0; v < vertexIds_.size(); ++v) slotOf_[vertexIds_[v]] = v;
    codeBaseValues(coder.births);
    if (hasCellField_) ancestry_.addBase(mesh_.tetrahedra);
    codeCellFields(0);
    mesh_.boundary = boundaryOf(mesh_.tetrahedra);
    mesh_.start(h_.lattice.bits);
    if (Status s = matchBoundary(); !s) return s;
    open_.entry.newBoundaryTriangles = static_cast<std::uint32_t>(mesh_.boundary.size());
    if (Status s = closeChunk(0, kLevelEnd); !s) return s;
    addLevel(0);
    return {};
  }

  void codeBaseValues(std::span<const BaseBirth> births) {
    const auto code = [&](Values& out, auto& tuples, std::uint32_t components, const auto& truth, const auto& next) {
      for (VertexId v = 0; v < births.size(); ++v)
        for (std::uint32_t c = 0; c < components; ++c) {
          const auto at = [&](VertexId u, std::uint32_t component) { return tuples(u, component); };
          next(out, births[v], v, c, at, truth(vertexIds_[v], c));
        }
    };
    for (const VertexId id : vertexIds_) mesh_.points.push_back(h_.points[id]);
    const auto point = [&](VertexId u, std::uint32_t c) { return mesh_.points[u][c]; };
    code(open_.positions, point, 3, [&](VertexId id, std::uint32_t c) { return h_.points[id][c]; },
         [](Values& out, const BaseBirth& birth, VertexId v, std::uint32_t c, const auto& at, std::int32_t truth) {
           out.code<true>(predictBase(birth, v, c, true, at), truth);
         });
    for (std::size_t f = 0; f < h_.fields.size(); ++f) {
      if (isCellField(h_.fields[f])) continue;
      const std::size_t n = h_.fields[f].components;
      for (const VertexId id : vertexIds_) values_[f].insert(values_[f].end(), fieldAt(f, id), fieldAt(f, id) + static_cast<std::ptrdiff_t>(n));
      const auto value = [&](VertexId u, std::uint32_t c) { return values_[f][u * n + c]; };
      code(open_.fields[f], value, static_cast<std::uint32_t>(n), [&](VertexId id, std::uint32_t c) { return fieldAt(f, id)[c]; },
           [gaps = h_.fields[f].gaps](Values& out, const BaseBirth& birth, VertexId v, std::uint32_t c, const auto& at, std::int32_t truth) {
             out.codeField<true>(gaps, predictBaseField(birth, v, c, gaps, at), truth);
           });
    }
  }

  [[nodiscard]] std::vector<std::int32_t>::const_iterator fieldAt(std::size_t field, VertexId id) const {
    return h_.values[field].begin() + static_cast<std::ptrdiff_t>(std::size_t{id} * h_.fields[field].components);
  }

  // The decoder derives the base mesh's boundary; the history's ghost cells must be the same triangles.
  Status matchBoundary() {
    std::vector<std::pair<Triangle, std::uint32_t>> ghosts;
    for (std::uint32_t i = 0; i < h_.cells.size(); ++i)
      if (const auto& c = h_.cells[i]; h_.live[i] && std::ranges::find(c, kGhost) != c.end()) {
        const auto turned = withLast(c, static_cast<std::size_t>(std::ranges::find(c, kGhost) - c.begin()));
        ghosts.emplace_back(sortedFace({slotOf_[turned[0]], slotOf_[turned[1]], slotOf_[turned[2]]}), i);
      }
    std::ranges::sort(ghosts);
    for (const Triangle& t : mesh_.boundary) {
      const auto at = std::ranges::lower_bound(ghosts, std::pair{sortedFace(t), 0u});
      if (at == ghosts.end() || at->first != sortedFace(t)) return fail(ErrorCode::kBadValue, "a boundary face of the base mesh has no ghost cell");
      boundaryIds_.push_back(at->second);
    }
    if (ghosts.size() != boundaryIds_.size()) return fail(ErrorCode::kBadValue, "a ghost cell of the base mesh has no boundary face");
    return {};
  }

  Status encodeLevel(std::uint32_t level) {
    if (open_.entry.firstLevel == 0) open_.entry.firstLevel = level;
    mesh_.beginLevel(level);
    std::optional<std::uint64_t> begun = estimatedBytes();  // none once a chunk ended within the level
    RecordCoder<RangeEncoder> coder(range_, models_, mesh_, link_, open_.positions);
    for (VertexId v = 0; v < mesh_.levelVertices(); ++v) {
      if (!mesh_.maysplit(v)) continue;
      const std::uint32_t fusion = fusionOf_[vertexIds_[v]];
      const bool splits = fusion != kNone && levelOf(h_.fusions[fusion]) == level;
      coder.splits(v, level, splits);
      if (!splits) continue;
      if (Status s = record(coder, v, h_.fusions[fusion]); !s) return s;
      if (estimatedBytes() < chunkTarget()) continue;
      if (Status s = closeChunk(level, v + 1); !s) return s;
      open_.entry.firstLevel = level;
      begun.reset();
    }
    // Near enough, if another level like this one would go further beyond the target than this one stays below it: let the next chunk begin with a level.
    const std::uint64_t bytes = estimatedBytes(), target = chunkTarget();
    const std::uint64_t levelBytes = begun ? bytes - *begun : target;
    if (2 * bytes + levelBytes < 2 * target) return {};
    return closeChunk(level, kLevelEnd);
  }

  // The estimate of the values, corrected by how far it was off in the chunks before.
  [[nodiscard]] std::uint64_t estimatedBytes() const { return range_.size() + open_.valueBits / 8 * (1 + valueBytes_) / (1 + valueBits_ / 8); }

  [[nodiscard]] std::uint64_t chunkTarget() const {
    return std::min<std::uint64_t>(options_.chunkBytes, std::max<std::uint64_t>(kLeastChunkBytes, body_.size() / kGrowth));
  }

  Status record(RecordCoder<RangeEncoder>& coder, VertexId v, Fusion fusion) {
    const auto bad = [&](const char* what) { return fail(ErrorCode::kBadValue, "fusion of vertex " + std::to_string(fusion.fused) + ": " + what); };
    if (mesh_.star(v).size() > kMaxLinkTriangles) return bad("its star has too many cells");
    if (!mesh_.enter(v, link_)) return bad("its link is not a closed surface");
    RecordTruth truth;
    truth.k = fusion.k;
    truth.placement = fusion.placement;
    if (!labels(v, fusion, truth)) return bad("the history's cells are not those of its star");
    number(fusion, truth);
    for (std::size_t i = 0; i < fusion.k; ++i) truth.points[i] = h_.points[fusion.prey[i]];
    if (!deleted(fusion, truth)) return bad("the history's cells are not those of its star");
    Split split;
    if (!coder.code(v, truth, split)) return bad("its cells cannot be described by labels");
    apply(v, fusion, split);
    return {};
  }

  bool labels(VertexId v, const Fusion& fusion, RecordTruth& truth) {
    for (std::uint32_t i = 0; i < fusion.affectedCount; ++i)
      labelOf_[h_.affectedCells[fusion.firstAffected + i]] = h_.affectedLabels[fusion.firstAffected + i];
    const std::span<const CellRef> star = mesh_.star(v);
    truth.labels.resize(star.size());
    bool whole = star.size() == fusion.affectedCount;
    for (std::size_t f = 0; f < star.size(); ++f) {
      const std::uint32_t id = star[f] & kBoundaryBit ? boundaryIds_[star[f] & ~kBoundaryBit] : tetrahedronIds_[star[f]];
      truth.labels[f] = std::exchange(labelOf_[id], kNoLabel);
      whole &= truth.labels[f] < fusion.k;
    }
    return whole;
  }

  // Numbers the prey vertices in order of first appearance along the link's traversal.
  void number(Fusion& fusion, RecordTruth& truth) {
    std::array<std::uint8_t, 4> now{kNoLabel, kNoLabel, kNoLabel, kNoLabel};
    std::uint8_t next = 0;
    for (const std::uint32_t f : link_.traversal())
      if (std::uint8_t& n = now[truth.labels[f]]; n == kNoLabel) n = next++;
    for (std::uint8_t& n : now)
      if (n == kNoLabel) n = next++;
    for (std::uint8_t& label : truth.labels) label = now[label];
    const auto prey = fusion.prey;
    for (std::size_t i = 0; i < fusion.k; ++i) fusion.prey[now[i]] = prey[i];
    truth.near = now[0];
  }

  bool deleted(const Fusion& fusion, RecordTruth& truth) {
    for (std::uint32_t i = 0; i < fusion.deletedCount; ++i) {
      LocalCell local{};
      const auto& cell = h_.cells[h_.deletedCells[fusion.firstDeleted + i]];
      for (std::size_t j = 0; j < 4; ++j) {
        const auto prey = std::find(fusion.prey.begin(), fusion.prey.begin() + fusion.k, cell[j]) - fusion.prey.begin();
        local[j] = prey < fusion.k ? kPreyBit | static_cast<LocalVertex>(prey) : link_.localOf(cell[j] == kGhost ? kGhost : slotOf_[cell[j]]);
        if (local[j] == kNoNeighbour) return false;
      }
      truth.deleted.push_back(sorted(local));
    }
    deletedIds_.clear();
    for (std::uint32_t i = 0; i < fusion.deletedCount; ++i) deletedIds_.emplace_back(truth.deleted[i], h_.deletedCells[fusion.firstDeleted + i]);
    std::ranges::sort(deletedIds_);
    std::ranges::sort(truth.deleted);
    return true;
  }

  void apply(VertexId v, const Fusion& fusion, const Split& split) {
    const std::size_t tetrahedra = mesh_.tetrahedra.size();
    const std::size_t triangles = mesh_.boundary.size();
    pointAncestry_.add(v, mesh_, link_, split);
    if (hasCellField_) ancestry_.addRestored(mesh_.star(v), link_, split.deleted);
    mesh_.apply(v, link_, split);
    for (const LocalCell& cell : split.deleted) {
      const std::uint32_t id = std::ranges::lower_bound(deletedIds_, std::pair{sorted(cell), 0u})->second;
      const bool ghost = std::ranges::find(h_.cells[id], kGhost) != h_.cells[id].end();
      (ghost ? boundaryIds_ : tetrahedronIds_).push_back(id);
    }
    vertexIds_[v] = fusion.prey[0];
    slotOf_[fusion.prey[0]] = v;
    for (std::size_t i = 1; i < fusion.k; ++i) slotOf_[fusion.prey[i]] = static_cast<std::uint32_t>(vertexIds_.size()), vertexIds_.push_back(fusion.prey[i]);
    for (std::size_t f = 0; f < h_.fields.size(); ++f)
      if (!isCellField(h_.fields[f])) codeField(f, fusion);
    codeCellFields(tetrahedra);
    ++open_.entry.records;
    open_.entry.newVertices += fusion.k - 1u;
    open_.entry.newTetrahedra += static_cast<std::uint32_t>(mesh_.tetrahedra.size() - tetrahedra);
    open_.entry.newBoundaryTriangles += static_cast<std::uint32_t>(mesh_.boundary.size() - triangles);
    estimate(open_.positions, std::size_t{fusion.k - 1u} * 3);
    for (std::size_t f = 0; f < h_.fields.size(); ++f)
      if (!isCellField(h_.fields[f])) estimate(open_.fields[f], fusion.k * h_.fields[f].components);
  }

  void codeField(std::size_t f, const Fusion& fusion) {
    const std::uint32_t n = h_.fields[f].components;
    std::vector<std::int32_t>& values = values_[f];
    values.resize(mesh_.points.size() * n);
    pointAncestry_.code<true>(
        pointAncestry_.births().back(), open_.fields[f], n, [&](VertexId v, std::uint32_t c) -> std::int32_t& { return values[std::size_t{v} * n + c]; },
        [&](std::size_t i, std::uint32_t c) { return fieldAt(f, fusion.prey[i])[c]; }, h_.fields[f].gaps);
  }

  // The values of the tetrahedra from slot `first` on, which have just come.
  void codeCellFields(std::size_t first) {
    for (std::size_t f = 0; f < h_.fields.size(); ++f) {
      if (!isCellField(h_.fields[f])) continue;
      const std::size_t n = h_.fields[f].components;
      for (std::size_t t = first; t < mesh_.tetrahedra.size(); ++t)
        for (std::size_t c = 0; c < n; ++c) {
          const auto at = [&](CellId u) { return h_.values[f][tetrahedronIds_[u] * n + c]; };
          const auto cell = static_cast<CellId>(t);
          const std::int64_t predicted = ancestry_.predict(cell, at);
          open_.fields[f].codeField<true>(h_.fields[f].gaps, predicted, at(cell));
          open_.valueBits += static_cast<std::uint64_t>(std::bit_width(static_cast<std::uint32_t>(std::abs(open_.fields[f].written().back()))));
        }
    }
  }

  // Draco takes about log2 of a residual's magnitude and two bits more.
  void estimate(Values& residuals, std::size_t count) {
    const auto& written = residuals.written();
    for (std::size_t i = written.size() - count; i < written.size(); ++i)
      open_.valueBits += 2 + static_cast<std::uint64_t>(std::bit_width(static_cast<std::uint32_t>(std::abs(written[i]))));
  }

  Status closeChunk(std::uint32_t level, std::uint32_t endSlot) {
    ChunkEntry& e = open_.entry;
    e.lastLevel = level;
    e.endSlot = endSlot;
    e.valueCodec = options_.valueCodec;
    if (chunks_.empty()) {
      e.newVertices = static_cast<std::uint32_t>(mesh_.points.size());
      e.newTetrahedra = static_cast<std::uint32_t>(mesh_.tetrahedra.size());
    } else {
      e.firstDependency = static_cast<std::uint32_t>(dependencies_.size());
      e.dependencyCount = 1;
      dependencies_.push_back(static_cast<std::uint32_t>(chunks_.size()) - 1);
    }
    if (Status s = addBlock(range_.finish()); !s) return s;
    for (std::size_t part = 0; part <= h_.fields.size(); ++part) {
      Values& residuals = part == 0 ? open_.positions : open_.fields[part - 1];
      Result<Bytes> block = encodeValueBlock(residuals.written(), part == 0 ? 3 : h_.fields[part - 1].components, options_.valueCodec);
      if (!block) return std::unexpected(block.error());
      if (Status s = addBlock(std::move(*block)); !s) return s;
      residuals.written().clear();
    }
    if (!chunks_.empty()) {
      for (std::size_t part = kPositionsPart; part < e.blocks.size(); ++part) valueBytes_ += e.blocks[part].size;
      valueBits_ += open_.valueBits;
    }
    chunks_.push_back(std::exchange(e, ChunkEntry{}));
    open_.valueBits = 0;
    return {};
  }

  Status addBlock(Bytes block) {
    if (block.size() > kMaxBlockBytes) return fail(ErrorCode::kLimitExceeded, "a block above 256 MiB; let the simplifier go further (--target-ratio)");
    open_.entry.blocks.push_back({0, static_cast<std::uint32_t>(block.size()), crc32c(block)});
    body_.insert(body_.end(), block.begin(), block.end());
    return {};
  }

  void addLevel(std::uint32_t level) {
    levels_.push_back({level, static_cast<std::uint32_t>(mesh_.tetrahedra.size()), static_cast<std::uint32_t>(mesh_.points.size()),
                       static_cast<std::uint32_t>(mesh_.boundary.size()), 0, std::nullopt});  // the table tells the chunk
    if (!options_.errors.empty()) levels_.back().error = options_.errors[level];
  }

  [[nodiscard]] Result<Bytes> manifest() const {
    Manifest m;
    m.generator = options_.generator;
    m.source = options_.source;
    m.latticeBits = h_.lattice.bits;
    m.latticeStep = h_.lattice.step;
    m.latticeOrigin = h_.lattice.origin;
    for (const FieldInfo& f : h_.fields) m.fields.push_back({f.name, f.components, f.type, f.association, f.bits, f.step, f.minimum, f.range, f.gaps});
    m.levels = levels_;
    return manifestBlock(m);
  }

  Result<EncodedLog> assemble() {
    LogIndex index;
    index.positionBits = static_cast<std::uint8_t>(h_.lattice.bits);
    Result<Bytes> manifestBytes = manifest();
    if (!manifestBytes) return std::unexpected(manifestBytes.error());
    index.manifest = std::move(*manifestBytes);
    for (const FieldInfo& f : h_.fields) index.fields.push_back({f.components, isCellField(f) ? Association::kCell : Association::kPoint, f.gaps});
    index.chunks = std::move(chunks_);
    index.dependencies = std::move(dependencies_);
    EncodedLog log;
    log.points = std::move(vertexIds_);
    log.tetrahedra = std::move(tetrahedronIds_);
    LogStatistics& s = log.statistics;
    s.headBytes = index.encode().size();
    s.fieldBytes.resize(h_.fields.size());
    std::uint64_t offset = s.headBytes;
    for (ChunkEntry& e : index.chunks) {
      e.offset = offset;
      for (std::size_t part = 0; part < e.blocks.size(); ++part) {
        offset += e.blocks[part].size;
        (part == kStructurePart ? s.structureBytes : part == kPositionsPart ? s.positionBytes : s.fieldBytes[part - kFirstFieldPart]) += e.blocks[part].size;
      }
      if (&e == &index.chunks.front()) s.baseBytes = offset - e.offset;
    }
    const std::uint64_t positionBytes = models_.positionCost / (64 * 8);
    s.structureBytes -= positionBytes;
    s.positionBytes += positionBytes;
    index.fileBytes = s.fileBytes = offset;
    s.chunks = static_cast<std::uint32_t>(index.chunks.size());
    s.levels = h_.levels;
    s.records = h_.fusions.size();
    log.bytes = index.encode();
    log.bytes.insert(log.bytes.end(), body_.begin(), body_.end());
    return log;
  }

  const FusionHistory& h_;
  const LogWriterOptions& options_;
  RangeEncoder range_;
  RecordModels models_;
  GrowingMesh mesh_;  // what the decoder will have
  bool hasCellField_ = false;
  CellAncestry ancestry_;
  PointAncestry pointAncestry_;
  Link link_;
  std::vector<std::vector<std::int32_t>> values_;
  std::vector<std::uint32_t> tetrahedronIds_, boundaryIds_;  // decoder's slot -> history's cell
  std::vector<VertexId> vertexIds_;                          // decoder's slot -> history's vertex
  std::vector<std::uint32_t> slotOf_;                        // the inverse
  std::vector<std::uint32_t> fusionOf_;                      // history's vertex -> the fusion that made it
  std::vector<std::uint8_t> labelOf_;
  std::vector<std::pair<LocalCell, std::uint32_t>> deletedIds_;
  OpenChunk open_;
  std::uint64_t valueBytes_ = 0, valueBits_ = 0;  // of the chunks closed since the base mesh: what the values took, and the estimates
  std::vector<ChunkEntry> chunks_;
  std::vector<std::uint32_t> dependencies_;
  std::vector<ManifestLevel> levels_;
  Bytes body_;
};

}  // namespace

Result<EncodedLog> encodeLog(const FusionHistory& history, const LogWriterOptions& options) { return LogEncoder(history, options).run(); }

}  // namespace qtet
