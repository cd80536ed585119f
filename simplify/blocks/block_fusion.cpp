#include "simplify/blocks/block_fusion.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

#include "codec/mesh/boundary.h"
#include "simplify/fuse/fusion_state.h"
#include "simplify/measure/measure_boundary.h"
#include "simplify/measure/measure_fields.h"
#include "simplify/mesh/missing_values.h"
#include "simplify/mesh/stopping.h"
#include "simplify/mesh/workers.h"

namespace qtet {
namespace {

/// Places on a block's boundary for its mean distance.
constexpr std::uint32_t kSurfaceSamples = 300;

Triangle sorted(Triangle t) {
  std::ranges::sort(t);
  return t;
}

/// Some triangles, asked for by their corners in any order.
class TriangleSet {
 public:
  void add(const Triangle& t) { triangles_.push_back(sorted(t)); }
  void close() { std::ranges::sort(triangles_); }
  [[nodiscard]] bool holds(const Triangle& t) const {
    return std::ranges::binary_search(triangles_, sorted(t));
  }

 private:
  std::vector<Triangle> triangles_;
};

/// The faces of cells that are in `boundary`, each with its cell. In the order of the cells.
std::vector<PieceTriangle> boundaryIn(std::span<const Tetrahedron> cells,
                                      const TriangleSet& boundary) {
  std::vector<PieceTriangle> out;
  const std::vector<Triangle> faces = boundaryOf(cells);
  auto next = faces.begin();
  for (CellId c = 0; c < cells.size() && next != faces.end(); ++c)
    for (int opposite = 0; opposite < 4 && next != faces.end(); ++opposite) {
      if (cellFace(cells[c], opposite) != *next) continue;
      if (boundary.holds(*next)) out.push_back({*next, c});
      ++next;
    }
  assert(next == faces.end());
  return out;
}

/// The block as a mesh of its own. Its boundary is first that of the whole, then the seams.
class BlockMesh {
 public:
  BlockMesh(Block& block, const BlockFrame& frame) {
    MeshPiece& piece = block.piece;
    mesh_.lattice = frame.lattice;
    mesh_.fields = frame.shape.fields;
    mesh_.points = std::move(piece.points);
    mesh_.tetrahedra = std::move(piece.tetrahedra);
    mesh_.values = std::move(piece.values);
    TriangleSet own;
    for (const PieceTriangle& t : piece.boundary) own.add(t.corners);
    own.close();
    std::vector<Triangle> seams;
    for (const Triangle& t : boundaryOf(mesh_.tetrahedra))
      (own.holds(t) ? mesh_.boundary : seams).push_back(t);
    triangles_ = mesh_.boundary.size();
    assert(triangles_ == piece.boundary.size());
    mesh_.boundary.insert(mesh_.boundary.end(), seams.begin(), seams.end());
    isSeam_.assign(mesh_.points.size(), 0);
    auto shared = block.shared.begin();
    for (VertexId v = 0; v < piece.vertices.size(); ++v) {
      shared = std::lower_bound(shared, block.shared.end(), piece.vertices[v]);
      if (shared != block.shared.end() && *shared == piece.vertices[v]) isSeam_[v] = 1;
    }
    for ([[maybe_unused]] const Triangle& t : seams)
      assert(std::ranges::all_of(t, [&](VertexId v) { return isSeam_[v] != 0; }));
  }

  [[nodiscard]] const LatticeMesh& mesh() const { return mesh_; }
  [[nodiscard]] LatticeMesh& mesh() { return mesh_; }
  /// Triangles of the whole's boundary.
  [[nodiscard]] std::size_t triangles() const { return triangles_; }
  [[nodiscard]] const std::vector<std::uint8_t>& isSeam() const { return isSeam_; }

 private:
  LatticeMesh mesh_;
  std::size_t triangles_ = 0;
  std::vector<std::uint8_t> isSeam_;
};

std::size_t regionFieldOf(const BlockFrame& frame) {
  return frame.options.regionField.value_or(FusionMesh::kNoRegions);
}

/// A block on its way through the band: fused, then followed level by level.
class BlockRun {
 public:
  /// `isSample`: countedLevels will be asked for.
  BlockRun(Block&& block, const BlockFrame& frame, bool isSample = false)
      : block_(std::move(block)), frame_(frame), own_(block_, frame), isSample_(isSample) {}

  PartLevels fuse(const PartEnd& end) {
    FusionState state = made();
    std::vector<VertexId> kept;
    for (VertexId v = 0; v < own_.isSeam().size(); ++v)
      if (own_.isSeam()[v]) kept.push_back(v);
    state.keep(kept);
    const auto firstSeam = static_cast<CellId>(own_.mesh().tetrahedra.size() + own_.triangles());
    const FusionFrame fusionFrame(own_.mesh(), state, frame_.options, firstSeam);
    Workers alone(1, frame_.options.stop);
    if (isSample_) findCounted();
    own_.mesh() = {};
    FusionOptions options = frame_.options;
    options.progress = {};
    FusionLoop loop(state, fusionFrame, options, alone);
    std::uint32_t levels = 0;
    PartLevels done;
    if (block_.isWhole) {
      Result<std::uint32_t> all = loop.run(end.cells);
      if (!all) throw BlockFailed{all.error()};
      levels = *all;
    } else {
      done = loop.runPart(end, {.isSeam = own_.isSeam(), .boxes = block_.others});
      levels = static_cast<std::uint32_t>(done.levels.size());
    }
    keepQuadrics(state);
    history_ = state.takeHistory(levels);
    return done;
  }

  /// The levels of what was fused, by the tetrahedra that they remove of those that count, and how
  /// many of these there were.
  [[nodiscard]] std::pair<std::vector<PartLevel>, std::size_t> countedLevels(
      std::vector<PartLevel> levels) const {
    for (PartLevel& level : levels) level.removed = 0;
    for (const Fusion& fusion : history_.fusions)
      for (std::size_t i = 0; i < fusion.deletedCount; ++i)
        levels[fusion.level].removed += isCounted(history_.deletedCells[fusion.firstDeleted + i]);
    return {std::move(levels), static_cast<std::size_t>(std::ranges::count(counts_, 1))};
  }

  FusedBlock take() {
    dropSeams();
    follow();
    FusedBlock out;
    out.moved = moved_;
    restoreFlags();
    takeCells(out.piece);
    takeVertices(out.piece);
    takePlaces(out.piece);
    return out;
  }

 private:
  [[nodiscard]] bool isCounted(CellId cell) const { return cell < counts_.size() && counts_[cell]; }

  /// Cells count that have no vertex of a seam. More rings would leave out the thin cells of a
  /// boundary layer, through which planes cut most.
  void findCounted() {
    for (const Tetrahedron& cell : own_.mesh().tetrahedra)
      counts_.push_back(std::ranges::none_of(cell, [&](VertexId v) { return own_.isSeam()[v]; }));
  }

  FusionState made() {
    if (!block_.piece.quadrics.empty())
      return {own_.mesh(), regionFieldOf(frame_), frame_.cost, block_.piece.quadrics};
    return {own_.mesh(), regionFieldOf(frame_), frame_.cost,
            std::span<const Triangle>(own_.mesh().boundary).first(own_.triangles())};
  }

  void keepQuadrics(const FusionState& state) {
    quadrics_.clear();
    for (VertexId v = 0; v < state.mesh().vertexSlots(); ++v) {
      if (!state.mesh().alive(v)) {
        quadrics_.resize(quadrics_.size() + frame_.shape.quadricSize, 0);
        continue;
      }
      const auto quadric = state.cost().quadric(v);
      assert(quadric.size() == frame_.shape.quadricSize);
      quadrics_.insert(quadrics_.end(), quadric.begin(), quadric.end());
    }
    block_.piece.quadrics = {};
  }

  /// Seams are no boundary: nothing is as near to them as it seems.
  void dropSeams() {
    const auto isTetrahedron = [](const Tetrahedron& cell) { return cell[3] != kGhost; };
    firstGhost_ = static_cast<CellId>(std::ranges::partition_point(history_.cells, isTetrahedron) -
                                      history_.cells.begin());
    history_.cells.resize(firstGhost_ + own_.triangles());
    history_.live.resize(history_.cells.size());
  }

  void follow() {
    HistoryLevels levels(history_);
    for (; levels.level() < levels.finest(); levels.refine()) throwIfStopped(frame_.options.stop);
    Workers alone(1, frame_.options.stop);
    OriginalSamples places;  // lengths are in lattice steps, so the diagonal is 1
    places.volume6 = 1;
    for (const PiecePlace& place : block_.piece.places)
      places.places.push_back({frame_.samples->places[place.number].at, place.tetrahedron,
                               place.isCovered != 0, place.isOriginal != 0});
    MeasuredMesh mesh(levels, &places);
    FieldMeter fields(mesh, {.workers = &alone, .before = &places});
    BoundaryMeter boundary(mesh, {.levelSamples = kSurfaceSamples,
                                  .seed = block_.number + std::uint64_t{1},
                                  .workers = &alone});
    while (mesh.level() > 0) {
      mesh.coarsen();
      boundary.follow();
      fields.follow();
    }
    mesh.fitTree();
    fields.measure();
    for (std::size_t i = 0; i < places.places.size(); ++i) followed_.push_back(fields.placeAt(i));
    if (own_.triangles() == 0) return;
    boundary.search();
    moved_.toMesh = boundary.toLevel().max;
    const OneSidedDistance back = boundary.toOriginal();
    moved_.toOriginal = back.max;
    moved_.area = areaOf(mesh.boundary());
    moved_.sum = back.mean * moved_.area;
  }

  [[nodiscard]] double areaOf(std::span<const std::uint32_t> ghosts) const {
    double area = 0;
    for (const std::uint32_t ghost : ghosts) {
      const Tetrahedron& t = history_.cells[ghost];
      const Vector3 a = toVector(history_.points[t[0]]);
      const Vector3 n =
          cross(toVector(history_.points[t[1]]) - a, toVector(history_.points[t[2]]) - a);
      area += 0.5 * std::sqrt(dot(n, n));
    }
    return area;
  }

  /// Flags of missing values for the fused vertices too.
  void restoreFlags() {
    for (std::size_t f = 0; f < block_.piece.missing.size(); ++f) {
      std::vector<std::uint8_t>& flags = block_.piece.missing[f];
      if (flags.empty() || isCellField(frame_.shape.fields[f])) continue;
      flags = missingOfFused(history_, frame_.shape.fields[f].components, std::move(flags));
    }
  }

  void takeCells(MeshPiece& out) {
    numbers_.assign(history_.points.size(), kGhost);
    for (CellId c = 0; c < firstGhost_; ++c) {
      if (!history_.live[c]) continue;
      cells_.push_back(c);
      out.tetrahedra.push_back(history_.cells[c]);
      for (const VertexId v : history_.cells[c]) numbers_[v] = 0;
    }
    for (VertexId v = 0; v < numbers_.size(); ++v)
      if (numbers_[v] != kGhost) {
        numbers_[v] = static_cast<VertexId>(vertices_.size());
        vertices_.push_back(v);
      }
    for (Tetrahedron& cell : out.tetrahedra)
      for (VertexId& v : cell) v = numbers_[v];
    TriangleSet boundary;
    for (std::size_t c = firstGhost_; c < history_.cells.size(); ++c)
      if (history_.live[c]) {
        const Tetrahedron& t = history_.cells[c];
        boundary.add({numbers_[t[0]], numbers_[t[1]], numbers_[t[2]]});
      }
    boundary.close();
    out.boundary = boundaryIn(out.tetrahedra, boundary);
  }

  void takeVertices(MeshPiece& out) {
    const std::vector<WholeVertex>& old = block_.piece.vertices;
    for (const VertexId v : vertices_) {
      out.vertices.push_back(v < old.size() ? old[v]
                                            : newVertex(block_.band, block_.number,
                                                        v - static_cast<VertexId>(old.size())));
      out.points.push_back(history_.points[v]);
      append(quadrics_, v, frame_.shape.quadricSize, out.quadrics);
    }
    out.values.resize(frame_.shape.fields.size());
    out.missing.resize(frame_.shape.fields.size());
    for (std::size_t f = 0; f < frame_.shape.fields.size(); ++f) {
      const std::size_t n = frame_.shape.fields[f].components;
      const bool ofCells = isCellField(frame_.shape.fields[f]);
      for (const std::uint32_t i : ofCells ? cells_ : vertices_) {
        append(history_.values[f], i, n, out.values[f]);
        append(block_.piece.missing[f], i, n, out.missing[f]);
      }
    }
  }

  /// Where a place is not covered, a cell of the nearest boundary triangle holds it.
  void takePlaces(MeshPiece& out) const {
    std::vector<CellId> numberOf(firstGhost_, 0);
    for (CellId i = 0; i < cells_.size(); ++i) numberOf[cells_[i]] = i;
    std::vector<std::pair<Triangle, CellId>> cellAt;
    for (const PieceTriangle& t : out.boundary)
      cellAt.emplace_back(sorted(t.corners), t.tetrahedron);
    std::ranges::sort(cellAt);
    for (std::size_t i = 0; i < followed_.size(); ++i) {
      const FollowedPlace& place = followed_[i];
      CellId cell = 0;
      if (place.isCovered) {
        cell = numberOf[place.tetrahedron];
      } else {
        const Tetrahedron& t = history_.cells[place.tetrahedron];
        const Triangle own = sorted({numbers_[t[0]], numbers_[t[1]], numbers_[t[2]]});
        const auto at =
            std::ranges::lower_bound(cellAt, own, {}, &std::pair<Triangle, CellId>::first);
        assert(at != cellAt.end() && at->first == own);
        cell = at->second;
      }
      out.places.push_back({block_.piece.places[i].number, cell,
                            static_cast<std::uint16_t>(place.isCovered),
                            static_cast<std::uint16_t>(place.isOriginal)});
    }
  }

  template <class T>
  static void append(const std::vector<T>& from, std::size_t i, std::size_t n, std::vector<T>& to) {
    if (from.empty()) return;
    const auto first = from.begin() + static_cast<std::ptrdiff_t>(i * n);
    to.insert(to.end(), first, first + static_cast<std::ptrdiff_t>(n));
  }

  Block block_;
  const BlockFrame& frame_;
  BlockMesh own_;
  bool isSample_;
  std::vector<std::uint8_t> counts_;  // by tetrahedron, where it is a sample
  FusionHistory history_;
  std::vector<double> quadrics_;  // by vertex of the history
  CellId firstGhost_ = 0;
  std::vector<FollowedPlace> followed_;  // by place of the piece
  BoundaryMove moved_;
  std::vector<VertexId> vertices_;  // that are left, ascending
  std::vector<VertexId> numbers_;   // of them, by vertex of the history
  std::vector<CellId> cells_;       // that are left, ascending
};

}  // namespace

CellMiddle middleOf(std::span<const LatticePoint> points, const Tetrahedron& cell) {
  CellMiddle out{};
  for (const VertexId v : cell)
    for (std::size_t axis = 0; axis < 3; ++axis)
      out[axis] += static_cast<std::uint32_t>(points[v][axis]);
  return out;
}

FusedBlock fuseBlock(Block&& block, const BlockFrame& frame, const PartEnd& end) {
  BlockRun run(std::move(block), frame);
  static_cast<void>(run.fuse(end));
  return run.take();
}

SampledParts sampleParts(const Block& block, const BlockFrame& frame, std::size_t cells,
                         std::uint32_t oneIn, double share) {
  std::vector<CellMiddle> middles;
  for (CellId c = 0; c < block.piece.tetrahedra.size(); ++c)
    middles.push_back(middleOf(block.piece, c));
  const auto wanted = static_cast<std::uint32_t>(middles.size() / cells);
  const BlockPlanes planes(middles, std::max(wanted, 1u));
  const std::uint32_t first = (block.band + block.number) % std::min(oneIn, planes.count());
  const std::uint32_t chosen = (planes.count() - first + oneIn - 1) / oneIn;
  std::vector<std::uint32_t> partOf;
  for (const CellMiddle& middle : middles) {
    const std::uint32_t part = planes.blockOf(middle);
    partOf.push_back(part % oneIn == first ? part / oneIn : kNoBlock);
  }
  std::vector<MeshPiece> parts;
  Result<std::vector<WholeVertex>> shared =
      deal(block.piece, frame.shape, partOf, chosen, [&](std::uint32_t, MeshPiece&& piece) {
        parts.push_back(std::move(piece));
        return Status{};
      });
  assert(shared);  // nothing fails here
  shared->insert(shared->end(), block.shared.begin(), block.shared.end());
  std::ranges::sort(*shared);
  SampledParts out;
  for (MeshPiece& piece : parts) {
    piece.places.clear();
    const double left = share * static_cast<double>(piece.tetrahedra.size());
    const PartEnd end{.cells = static_cast<std::size_t>(left), .leastShare = 0};
    Block part{block.band, block.number, false, std::move(piece), *shared, block.others};
    BlockRun run(std::move(part), frame, true);
    const PartLevels done = run.fuse(end);
    auto [levels, counted] = run.countedLevels(done.levels);
    out.levels.push_back(std::move(levels));
    out.cells += counted;
  }
  return out;
}

}  // namespace qtet
