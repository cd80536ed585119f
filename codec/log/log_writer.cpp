#include "codec/log/log_writer.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <optional>
#include <string>

#include "codec/log/log_index.h"
#include "codec/log/log_manifest.h"
#include "codec/log/value_block.h"
#include "codec/mesh/growing_mesh.h"
#include "codec/mesh/node_cells.h"
#include "codec/record/base_coder.h"
#include "codec/record/cell_values.h"
#include "codec/record/child_coder.h"
#include "codec/record/point_values.h"
#include "codec/record/record_coder.h"
#include "proto/crc32c.h"
#include "proto/limits.h"

namespace qtet {
namespace {

constexpr std::uint32_t kNone = 0xFFFFFFFFu;

// A picture sharpens when a chunk is whole, so that each is a share of what a viewer has already
// waited for, up to LogWriterOptions::chunkBytes. Smaller ones cost more than they give: a row of
// the table and Draco's fixed bytes are 130 bytes a chunk with one field, 3 % of 4 KB.
constexpr std::uint64_t kLeastChunkBytes = 4 << 10;
constexpr std::uint64_t kGrowth = 3;

/// A chunk under construction.
struct OpenChunk {
  ChunkEntry entry;
  Values positions;
  std::vector<Values> fields;
  std::uint64_t valueBits = 0;  // estimate of what the values will take
};

/// The levels that keep to the nodes at one depth.
struct Band {
  std::uint32_t firstLevel = 0, lastLevel = 0, depth = 0;
};

// Twice as many packets as leaves stay below kMaxChunks.
constexpr std::uint32_t kMaxDepth = 18;

class LogEncoder {
 public:
  LogEncoder(const FusionHistory& history, const LogWriterOptions& options)
      : h_(history), options_(options) {}

  Result<EncodedLog> run() {
    if (Status s = prepare(); !s) return std::unexpected(s.error());
    if (Status s = base(); !s) return std::unexpected(s.error());
    for (std::uint32_t level = 1; level <= headLevels_; ++level) {
      if (Status s = encodeLevel(level); !s) return std::unexpected(s.error());
      tellProgress();
    }
    if (open_.entry.records > 0 || open_.entry.firstLevel != 0) {
      if (Status s = endHead(); !s) return std::unexpected(s.error());
      if (Status s = closeChunk(headLevels_, kLevelEnd); !s) return std::unexpected(s.error());
    }
    for (std::uint32_t band = 0; band < bands_.size(); ++band)
      if (Status s = encodeBand(bands_[band]); !s) return std::unexpected(s.error());
    if (recordsWritten_ != h_.fusions.size())
      return fail(ErrorCode::kBadValue,
                  "a fusion of the history belongs to a level or a node of the tree in which its "
                  "vertex is not; simplify the mesh again");
    findBoxes();
    return assemble();
  }

 private:
  Status prepare() {
    if (h_.levels > kMaxLevels) return fail(ErrorCode::kLimitExceeded, "more than 4,096 levels");
    if (!options_.errors.empty() && options_.errors.size() != h_.levels + 1u)
      return fail(ErrorCode::kBadValue, "there are known errors of " +
                                            std::to_string(options_.errors.size()) +
                                            " levels, but " + std::to_string(h_.levels + 1u) +
                                            " levels; measure the history that is encoded");
    if (h_.fields.size() > kMaxFields)
      return fail(ErrorCode::kLimitExceeded, "more than 256 fields; choose some with --fields");
    if (h_.points.size() > kMaxElements || h_.cells.size() > kMaxElements)
      return fail(ErrorCode::kLimitExceeded, "more than 2^29 cells");
    if (Status s = prepareBands(); !s) return s;
    added_.resize(h_.levels + 1u);
    fusionOf_.assign(h_.points.size(), kNone);
    for (std::uint32_t i = 0; i < h_.fusions.size(); ++i) fusionOf_[h_.fusions[i].fused] = i;
    slotOf_.assign(h_.points.size(), kNone);
    labelOf_.assign(h_.cells.size(), kNoLabel);
    values_.resize(h_.fields.size());
    open_.fields.resize(h_.fields.size());
    hasCellField_ = std::ranges::any_of(h_.fields, isCellField);
    pointAncestry_ = PointAncestry(!std::ranges::all_of(h_.fields, isCellField));
    const auto ghosts = std::ranges::count_if(
        h_.cells, [](const auto& c) { return std::ranges::find(c, kGhost) != c.end(); });
    const std::size_t tetrahedra = h_.cells.size() - static_cast<std::size_t>(ghosts);
    for (std::size_t f = 0; f < h_.fields.size(); ++f)
      if (isCellField(h_.fields[f]) && h_.values[f].size() != tetrahedra * h_.fields[f].components)
        return fail(ErrorCode::kBadValue, "cell field " + h_.fields[f].name + " has " +
                                              std::to_string(h_.values[f].size()) +
                                              " numbers for " + std::to_string(tetrahedra) +
                                              " tetrahedra");
    return {};
  }

  // The history may have lost its coarsest levels since it was made: bands are what is left of
  // them, coarsest first.
  Status prepareBands() {
    const Bands& bands = h_.bands;
    headLevels_ = h_.levels;
    if (bands.ends.empty()) return {};
    const auto bad = [](const char* what) {
      return fail(ErrorCode::kBadValue,
                  std::string("the history's bands: ") + what + "; simplify the mesh again");
    };
    if (bands.depth > kMaxDepth || bands.ends.size() > bands.depth)
      return bad("more than the tree has depths, or a tree too deep");
    if (bands.leaf.size() != h_.cells.size()) return bad("not every cell has a leaf");
    if (std::ranges::any_of(bands.leaf,
                            [&](std::uint32_t leaf) { return leaf >> bands.depth != 0; }))
      return bad("a leaf that the tree does not have");
    for (std::uint32_t b = 0, first = 0; b < bands.ends.size() && first < h_.levels; ++b) {
      if (bands.ends[b] <= first) return bad("one without a level");
      const std::uint32_t end = std::min(bands.ends[b], h_.levels);
      bands_.insert(bands_.begin(), {h_.levels - end + 1, h_.levels - first, bands.depth - b});
      first = end;
    }
    if (!bands_.empty()) headLevels_ = bands_.front().firstLevel - 1;
    waiting_.resize(std::size_t{2} << bands.depth);
    return {};
  }

  void tellProgress() const {
    if (options_.progress)
      options_.progress(static_cast<double>(mesh_.tetrahedra.size()) /
                        static_cast<double>(h_.cells.size()));
  }

  [[nodiscard]] std::uint32_t levelOf(const Fusion& f) const { return h_.levels - f.level; }

  Status base() {
    std::vector<Tetrahedron> cells;
    std::vector<std::uint32_t> ids;
    for (std::uint32_t i = 0; i < h_.cells.size(); ++i)
      if (h_.live[i] && std::ranges::find(h_.cells[i], kGhost) == h_.cells[i].end())
        cells.push_back(h_.cells[i]), ids.push_back(i);
    std::vector<VertexId> used;
    for (const Tetrahedron& t : cells) used.insert(used.end(), t.begin(), t.end());
    std::ranges::sort(used);
    used.erase(std::ranges::unique(used).begin(), used.end());

    BaseTruth truth(cells);
    BaseCoder<RangeEncoder> coder(range_, static_cast<std::uint32_t>(used.size()),
                                  static_cast<std::uint32_t>(cells.size()));
    const bool coded = coder.run(&truth, [this] { return options_.stop.stop_requested(); });
    if (options_.stop.stop_requested()) return cancelled();
    if (!coded)
      return fail(ErrorCode::kBadValue,
                  "two cells of the base mesh disagree on the orientation of their face");
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
    added_[0] = mesh_.next();
    if (headLevels_ == 0)
      if (Status s = endHead(); !s) return s;
    return closeChunk(0, kLevelEnd);
  }

  void codeBaseValues(std::span<const BaseBirth> births) {
    const auto code = [&](Values& out, auto& tuples, std::uint32_t components, const auto& truth,
                          const auto& next) {
      for (VertexId v = 0; v < births.size(); ++v)
        for (std::uint32_t c = 0; c < components; ++c) {
          const auto at = [&](VertexId u, std::uint32_t component) { return tuples(u, component); };
          next(out, births[v], v, c, at, truth(vertexIds_[v], c));
        }
    };
    for (const VertexId id : vertexIds_) mesh_.points.push_back(h_.points[id]);
    const auto point = [&](VertexId u, std::uint32_t c) { return mesh_.points[u][c]; };
    code(
        open_.positions, point, 3, [&](VertexId id, std::uint32_t c) { return h_.points[id][c]; },
        [](Values& out, const BaseBirth& birth, VertexId v, std::uint32_t c, const auto& at,
           std::int32_t truth) { out.code<true>(predictBase(birth, v, c, true, at), truth); });
    for (std::size_t f = 0; f < h_.fields.size(); ++f) {
      if (isCellField(h_.fields[f])) continue;
      const std::size_t n = h_.fields[f].components;
      for (const VertexId id : vertexIds_)
        values_[f].insert(values_[f].end(), fieldAt(f, id),
                          fieldAt(f, id) + static_cast<std::ptrdiff_t>(n));
      const auto value = [&](VertexId u, std::uint32_t c) { return values_[f][u * n + c]; };
      code(
          open_.fields[f], value, static_cast<std::uint32_t>(n),
          [&](VertexId id, std::uint32_t c) { return fieldAt(f, id)[c]; },
          [hasMissing = h_.fields[f].hasMissing](Values& out, const BaseBirth& birth, VertexId v,
                                                 std::uint32_t c, const auto& at,
                                                 std::int32_t truth) {
            out.codeField<true>(hasMissing, predictBaseField(birth, v, c, hasMissing, at), truth);
          });
    }
  }

  [[nodiscard]] std::vector<std::int32_t>::const_iterator fieldAt(std::size_t field,
                                                                  VertexId id) const {
    return h_.values[field].begin() +
           static_cast<std::ptrdiff_t>(std::size_t{id} * h_.fields[field].components);
  }

  // The decoder derives the base mesh's boundary; the history's ghost cells must be the same
  // triangles.
  Status matchBoundary() {
    std::vector<std::pair<Triangle, std::uint32_t>> ghosts;
    for (std::uint32_t i = 0; i < h_.cells.size(); ++i)
      if (const auto& c = h_.cells[i]; h_.live[i] && std::ranges::find(c, kGhost) != c.end()) {
        const auto turned =
            withLast(c, static_cast<std::size_t>(std::ranges::find(c, kGhost) - c.begin()));
        ghosts.emplace_back(
            sortedFace({slotOf_[turned[0]], slotOf_[turned[1]], slotOf_[turned[2]]}), i);
      }
    std::ranges::sort(ghosts);
    for (const Triangle& t : mesh_.boundary) {
      const auto at = std::ranges::lower_bound(ghosts, std::pair{sortedFace(t), 0u});
      if (at == ghosts.end() || at->first != sortedFace(t))
        return fail(ErrorCode::kBadValue, "a boundary face of the base mesh has no ghost cell");
      boundaryIds_.push_back(at->second);
    }
    if (ghosts.size() != boundaryIds_.size())
      return fail(ErrorCode::kBadValue, "a ghost cell of the base mesh has no boundary face");
    return {};
  }

  Status encodeLevel(std::uint32_t level) {
    if (open_.entry.firstLevel == 0) open_.entry.firstLevel = level;
    mesh_.beginLevel(level);
    level_ = level;
    // none once a chunk ended within the level
    std::optional<std::uint64_t> begun = estimatedBytes();
    RecordCoder<RangeEncoder> coder(range_, models_, mesh_, link_, open_.positions);
    for (VertexId v = 0; v < mesh_.levelVertices(); ++v) {
      if (!mesh_.maysplit(v)) continue;
      const Fusion* fusion = fusionAt(v, level);
      coder.splits(v, level, fusion != nullptr);
      if (fusion == nullptr) continue;
      if (Status s = record(coder, v, *fusion); !s) return s;
      if (estimatedBytes() < chunkTarget()) continue;
      if (Status s = closeChunk(level, v + 1); !s) return s;
      open_.entry.firstLevel = level;
      begun.reset();
    }
    positionCost_ += coder.positionCost();
    // Near enough, if another level like this one would go further beyond the target than this one
    // stays below it: let the next chunk begin with a level.
    const std::uint64_t bytes = estimatedBytes(), target = chunkTarget();
    const std::uint64_t levelBytes = begun ? bytes - *begun : target;
    if (2 * bytes + levelBytes < 2 * target || level == headLevels_) return {};
    return closeChunk(level, kLevelEnd);
  }

  [[nodiscard]] const Fusion* fusionAt(VertexId v, std::uint32_t level) const {
    const std::uint32_t fusion = fusionOf_[vertexIds_[v]];
    return fusion != kNone && levelOf(h_.fusions[fusion]) == level ? &h_.fusions[fusion] : nullptr;
  }

  // Before the head's last chunk is closed: to which of the first band's nodes each cell belongs.
  Status endHead() {
    if (bands_.empty()) return {};
    waiting_[1].add({}, mesh_.next());
    for (std::uint32_t node = 1; node < 1u << bands_.front().depth; ++node)
      if (Status s = codeChildren(node, std::exchange(waiting_[node], {})); !s) return s;
    headModels_ = models_;
    headChildModels_ = childModels_;
    headChunks_ = static_cast<std::uint32_t>(chunks_.size()) + 1;
    return {};
  }

  static Status failBeyondNode() {
    return fail(
        ErrorCode::kBadValue,
        "the history's bands: a fusion reaches beyond a node of the tree; simplify the mesh again");
  }

  [[nodiscard]] std::uint32_t historyCell(CellRef ref) const {
    return ref & kBoundaryBit ? boundaryIds_[ref & ~kBoundaryBit] : tetrahedronIds_[ref];
  }

  Status codeChildren(std::uint32_t node, const NodeCells& cells) {
    const auto depth = static_cast<std::uint32_t>(std::bit_width(node));  // of the children
    bool inNode = true;
    const auto truth = [&](CellRef ref) {
      const std::uint32_t child = 1u << depth | h_.bands.node(historyCell(ref), depth);
      inNode &= child / 2 == node;
      return static_cast<int>(child & 1u);
    };
    std::array<NodeCells, 2> halves;
    const std::size_t before = range_.size();
    if (!ChildCoder<RangeEncoder>(range_, childModels_, mesh_, h_.lattice.bits, counts_)
             .code(cells, truth, halves) ||
        !inNode)
      return failBeyondNode();
    childBytes_ += range_.size() - before;
    for (std::uint32_t i = 0; i < 2; ++i) waiting_[2 * node + i] = std::move(halves[i]);
    return {};
  }

  Status encodeBand(const Band& band) {
    for (std::uint32_t node = 1u << band.depth; node < 2u << band.depth; ++node)
      if (Status s = encodePacket(band, node); !s) return s;
    tellProgress();
    return {};
  }

  // Of the leaves the boxes of their cells, which are all there now; of the other nodes the boxes
  // of their children.
  void findBoxes() {
    if (bands_.empty()) return;
    const std::uint32_t firstNode = 1u << bands_.front().depth;
    for (std::size_t i = headChunks_; i < chunks_.size(); ++i)
      chunks_[i].box = {{255, 255, 255}, {0, 0, 0}};
    const auto grow = [](PacketBox& box, const PacketBox& by) {
      for (std::size_t a = 0; a < 3; ++a)
        box.least[a] = std::min(box.least[a], by.least[a]),
        box.most[a] = std::max(box.most[a], by.most[a]);
    };
    const auto chunkOf = [&](std::uint32_t node) -> ChunkEntry& {
      return chunks_[headChunks_ + node - firstNode];
    };
    const std::uint32_t depth = bands_.back().depth;
    for (CellId t = 0; t < mesh_.tetrahedra.size(); ++t)
      for (const VertexId v : mesh_.tetrahedra[t]) {
        std::array<std::uint8_t, 3> at{};
        for (std::size_t a = 0; a < 3; ++a)
          at[a] =
              static_cast<std::uint8_t>((std::int64_t{mesh_.points[v][a]} << 8) >> h_.lattice.bits);
        grow(chunkOf(1u << depth | h_.bands.node(tetrahedronIds_[t], depth)).box, {at, at});
      }
    for (std::uint32_t node = (2u << depth) - 1; node >= 2 * firstNode; --node)
      grow(chunkOf(node / 2).box, chunkOf(node).box);
  }

  // The mirror of Refiner::State::packet.
  Status encodePacket(const Band& band, std::uint32_t node) {
    models_ = headModels_;
    childModels_ = headChildModels_;
    open_.entry.firstLevel = band.firstLevel;
    open_.entry.node = node;
    NodeCells cells = std::exchange(waiting_[node], {});
    const Slots first = mesh_.next();
    std::vector<VertexId> inner = innerVertices(mesh_, cells, counts_);
    RecordCoder<RangeEncoder> coder(range_, models_, mesh_, link_, open_.positions);
    for (level_ = band.firstLevel; level_ <= band.lastLevel; ++level_) {
      mesh_.beginLevel(level_);
      const VertexId firstNew = mesh_.next().vertices;
      const std::size_t vertices = inner.size();
      for (std::size_t i = 0; i < vertices; ++i) {
        if (!mesh_.maysplit(inner[i])) continue;
        const Fusion* fusion = fusionAt(inner[i], level_);
        coder.splits(inner[i], level_, fusion != nullptr);
        if (fusion == nullptr) continue;
        if (Status s = record(coder, inner[i], *fusion); !s) return s;
      }
      for (VertexId v = firstNew; v < mesh_.next().vertices; ++v) inner.push_back(v);
    }
    positionCost_ += coder.positionCost();
    cells.add(first, mesh_.next());
    if (band.depth < h_.bands.depth) {
      if (Status s = codeChildren(node, cells); !s) return s;
    } else {
      bool inNode = true;
      cells.forEach([&](CellRef ref) {
        inNode &= (1u << band.depth | h_.bands.node(historyCell(ref), band.depth)) == node;
      });
      if (!inNode) return failBeyondNode();
    }
    return closeChunk(band.lastLevel, kLevelEnd);
  }

  // The estimate of the values, corrected by how far it was off in the chunks before.
  [[nodiscard]] std::uint64_t estimatedBytes() const {
    return range_.size() + open_.valueBits / 8 * (1 + valueBytes_) / (1 + valueBits_ / 8);
  }

  [[nodiscard]] std::uint64_t chunkTarget() const {
    return std::min<std::uint64_t>(
        options_.chunkBytes, std::max<std::uint64_t>(kLeastChunkBytes, body_.size() / kGrowth));
  }

  Status record(RecordCoder<RangeEncoder>& coder, VertexId v, Fusion fusion) {
    if (options_.stop.stop_requested()) return cancelled();
    const auto bad = [&](const char* what) {
      return fail(ErrorCode::kBadValue,
                  "fusion of vertex " + std::to_string(fusion.fused) + ": " + what);
    };
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
      labelOf_[h_.affectedCells[fusion.firstAffected + i]] =
          h_.affectedLabels[fusion.firstAffected + i];
    const std::span<const CellRef> star = mesh_.star(v);
    truth.labels.resize(star.size());
    bool whole = star.size() == fusion.affectedCount;
    for (std::size_t f = 0; f < star.size(); ++f) {
      truth.labels[f] = std::exchange(labelOf_[historyCell(star[f])], kNoLabel);
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
        const auto prey = std::find(fusion.prey.begin(), fusion.prey.begin() + fusion.k, cell[j]) -
                          fusion.prey.begin();
        local[j] = prey < fusion.k ? kPreyBit | static_cast<LocalVertex>(prey)
                                   : link_.localOf(cell[j] == kGhost ? kGhost : slotOf_[cell[j]]);
        if (local[j] == kNoNeighbour) return false;
      }
      truth.deleted.push_back(sorted(local));
    }
    deletedIds_.clear();
    for (std::uint32_t i = 0; i < fusion.deletedCount; ++i)
      deletedIds_.emplace_back(truth.deleted[i], h_.deletedCells[fusion.firstDeleted + i]);
    std::ranges::sort(deletedIds_);
    std::ranges::sort(truth.deleted);
    return true;
  }

  void apply(VertexId v, const Fusion& fusion, const Split& split) {
    const Slots before = mesh_.next();
    pointAncestry_.add(v, mesh_, link_, split);
    if (hasCellField_)
      ancestry_.addRestored(mesh_.star(v), link_, split.deleted, mesh_.next().tetrahedra);
    mesh_.apply(v, link_, split);
    for (const LocalCell& cell : split.deleted) {
      const std::uint32_t id =
          std::ranges::lower_bound(deletedIds_, std::pair{sorted(cell), 0u})->second;
      const bool ghost = std::ranges::find(h_.cells[id], kGhost) != h_.cells[id].end();
      (ghost ? boundaryIds_ : tetrahedronIds_).push_back(id);
    }
    vertexIds_[v] = fusion.prey[0];
    slotOf_[fusion.prey[0]] = v;
    for (std::size_t i = 1; i < fusion.k; ++i)
      slotOf_[fusion.prey[i]] = static_cast<std::uint32_t>(vertexIds_.size()),
      vertexIds_.push_back(fusion.prey[i]);
    for (std::size_t f = 0; f < h_.fields.size(); ++f)
      if (!isCellField(h_.fields[f])) codeField(f, fusion);
    codeCellFields(before.tetrahedra);
    const Slots brought{mesh_.next().vertices - before.vertices,
                        mesh_.next().tetrahedra - before.tetrahedra,
                        mesh_.next().triangles - before.triangles};
    for (auto [total, more] : {std::pair{&open_.entry.newVertices, brought.vertices},
                               {&open_.entry.newTetrahedra, brought.tetrahedra},
                               {&open_.entry.newBoundaryTriangles, brought.triangles},
                               {&added_[level_].vertices, brought.vertices},
                               {&added_[level_].tetrahedra, brought.tetrahedra},
                               {&added_[level_].triangles, brought.triangles}})
      *total += more;
    ++open_.entry.records;
    ++recordsWritten_;
    estimate(open_.positions, std::size_t{fusion.k - 1u} * 3);
    for (std::size_t f = 0; f < h_.fields.size(); ++f)
      if (!isCellField(h_.fields[f])) estimate(open_.fields[f], fusion.k * h_.fields[f].components);
  }

  void codeField(std::size_t f, const Fusion& fusion) {
    const std::uint32_t n = h_.fields[f].components;
    std::vector<std::int32_t>& values = values_[f];
    values.resize(mesh_.points.size() * n);
    pointAncestry_.code<true>(
        pointAncestry_.births().back(), open_.fields[f], n,
        [&](VertexId v, std::uint32_t c) -> std::int32_t& {
          return values[std::size_t{v} * n + c];
        },
        [&](std::size_t i, std::uint32_t c) { return fieldAt(f, fusion.prey[i])[c]; },
        h_.fields[f].hasMissing);
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
          open_.fields[f].codeField<true>(h_.fields[f].hasMissing, predicted, at(cell));
          open_.valueBits += static_cast<std::uint64_t>(std::bit_width(
              static_cast<std::uint32_t>(std::abs(open_.fields[f].written().back()))));
        }
    }
  }

  // Draco takes about log2 of a residual's magnitude and two bits more.
  void estimate(Values& residuals, std::size_t count) {
    const auto& written = residuals.written();
    for (std::size_t i = written.size() - count; i < written.size(); ++i)
      open_.valueBits += 2 + static_cast<std::uint64_t>(
                                 std::bit_width(static_cast<std::uint32_t>(std::abs(written[i]))));
  }

  Status closeChunk(std::uint32_t level, std::uint32_t endSlot) {
    ChunkEntry& e = open_.entry;
    e.lastLevel = level;
    e.endSlot = endSlot;
    e.valueCodec = options_.valueCodec;
    if (chunks_.empty()) {
      e.newVertices = static_cast<std::uint32_t>(mesh_.points.size());
      e.newTetrahedra = static_cast<std::uint32_t>(mesh_.tetrahedra.size());
    }
    if (Status s = addBlock(range_.finish()); !s) return s;
    for (std::size_t part = 0; part <= h_.fields.size(); ++part) {
      Values& residuals = part == 0 ? open_.positions : open_.fields[part - 1];
      Result<Bytes> block = encodeValueBlock(
          residuals.written(), part == 0 ? 3 : h_.fields[part - 1].components, options_.valueCodec);
      if (!block) return std::unexpected(block.error());
      if (Status s = addBlock(std::move(*block)); !s) return s;
      residuals.written().clear();
    }
    if (!chunks_.empty()) {
      for (std::size_t part = kPositionsPart; part < e.blocks.size(); ++part)
        valueBytes_ += e.blocks[part].size;
      valueBits_ += open_.valueBits;
    }
    chunks_.push_back(std::exchange(e, ChunkEntry{}));
    open_.valueBits = 0;
    return {};
  }

  Status addBlock(Bytes block) {
    if (block.size() > kMaxBlockBytes)
      return fail(ErrorCode::kLimitExceeded,
                  "a block above 256 MiB; let the simplifier go further (--target-ratio)");
    open_.entry.blocks.push_back({0, static_cast<std::uint32_t>(block.size()), crc32c(block)});
    body_.insert(body_.end(), block.begin(), block.end());
    return {};
  }

  [[nodiscard]] std::vector<ManifestLevel> levels() const {
    std::vector<ManifestLevel> out;
    Slots sum;
    for (std::uint32_t level = 0; level < added_.size(); ++level) {
      sum = {sum.vertices + added_[level].vertices, sum.tetrahedra + added_[level].tetrahedra,
             sum.triangles + added_[level].triangles};
      // the table tells the chunk
      out.push_back({level, sum.tetrahedra, sum.vertices, sum.triangles, 0, std::nullopt});
      if (!options_.errors.empty()) out.back().error = options_.errors[level];
    }
    return out;
  }

  [[nodiscard]] Result<Bytes> manifest() const {
    Manifest m;
    m.generator = options_.generator;
    m.source = options_.source;
    m.latticeBits = h_.lattice.bits;
    m.latticeStep = h_.lattice.step;
    m.latticeOrigin = h_.lattice.origin;
    for (const FieldInfo& f : h_.fields)
      m.fields.push_back({f.name, f.components, f.type, f.association, f.bits, f.step, f.minimum,
                          f.range, f.hasMissing});
    m.levels = levels();
    return manifestBlock(m);
  }

  Result<EncodedLog> assemble() {
    LogIndex index;
    index.layout = bands_.empty() ? Layout::kStream : Layout::kRegions;
    index.positionBits = static_cast<std::uint8_t>(h_.lattice.bits);
    Result<Bytes> manifestBytes = manifest();
    if (!manifestBytes) return std::unexpected(manifestBytes.error());
    index.manifest = std::move(*manifestBytes);
    for (const FieldInfo& f : h_.fields)
      index.fields.push_back(
          {f.components, isCellField(f) ? Association::kCell : Association::kPoint, f.hasMissing});
    index.chunks = std::move(chunks_);
    // their number stands in the header; what they are follows from the rows
    index.dependencies.resize(index.chunks.size() - 1);
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
        (part == kStructurePart   ? s.structureBytes
         : part == kPositionsPart ? s.positionBytes
                                  : s.fieldBytes[part - kFirstFieldPart]) += e.blocks[part].size;
      }
      if (&e == &index.chunks.front()) s.baseBytes = offset - e.offset;
    }
    const std::uint64_t positionBytes = positionCost_ / (64 * 8);
    s.structureBytes -= positionBytes;
    s.positionBytes += positionBytes;
    index.fileBytes = s.fileBytes = offset;
    s.chunks = static_cast<std::uint32_t>(index.chunks.size());
    s.levels = h_.levels;
    s.records = h_.fusions.size();
    s.childBytes = childBytes_;
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
  // history's vertex -> the fusion that made it
  std::vector<std::uint32_t> fusionOf_;
  std::vector<std::uint8_t> labelOf_;
  std::vector<std::pair<LocalCell, std::uint32_t>> deletedIds_;
  // what positions took of the structure blocks, in 64ths of a bit
  std::uint64_t positionCost_ = 0;
  OpenChunk open_;
  // of the chunks closed since the base mesh: what the values took, and the estimates
  std::uint64_t valueBytes_ = 0, valueBits_ = 0;
  std::vector<ChunkEntry> chunks_;
  std::vector<Band> bands_;  // coarsest first; none: `stream`
  std::uint32_t headLevels_ = 0, headChunks_ = 0;
  RecordModels headModels_;
  ChildModels childModels_, headChildModels_;
  std::vector<NodeCells> waiting_;  // by node
  VertexCounts counts_;
  std::uint32_t level_ = 0;   // in hand
  std::vector<Slots> added_;  // by level
  std::size_t recordsWritten_ = 0;
  std::uint64_t childBytes_ = 0;
  Bytes body_;
};

}  // namespace

Result<EncodedLog> encodeLog(const FusionHistory& history, const LogWriterOptions& options) {
  return LogEncoder(history, options).run();
}

}  // namespace qtet
