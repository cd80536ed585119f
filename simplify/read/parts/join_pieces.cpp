#include "simplify/read/parts/join_pieces.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <compare>
#include <map>
#include <numeric>
#include <vector>

#include "simplify/read/parts/near_points.h"
#include "simplify/read/parts/point_sets.h"
#include "simplify/read/parts/point_values.h"
#include "simplify/split/cell_shapes.h"

namespace qtet {
namespace {

/// Points with one id lie at one place up to rounding: this fraction of the box's diagonal.
constexpr double kSamePlace = 1e-6;

/// The points in runs of those that `same` calls one; runs of one point are left out. Within a run
/// they ascend, and so do their pieces.
template <class Less>
class Runs {
 public:
  Runs(std::size_t points, Less less) : order_(points), less_(less) {
    std::iota(order_.begin(), order_.end(), VertexId{0});
    std::ranges::sort(
        order_, [&](VertexId a, VertexId b) { return less_(a, b) || (!less_(b, a) && a < b); });
  }
  template <class Visit>
  void each(const Visit& visit) const {
    for (std::size_t i = 0; i < order_.size();) {
      std::size_t end = i + 1;
      while (end < order_.size() && !less_(order_[i], order_[end])) ++end;
      if (end - i > 1) visit(std::span(order_).subspan(i, end - i));
      i = end;
    }
  }

 private:
  std::vector<VertexId> order_;
  Less less_;
};

bool everyPieceOnce(std::span<const VertexId> run, const PieceOf& pieceOf) {
  for (std::size_t i = 1; i < run.size(); ++i)
    if (pieceOf(run[i - 1]) == pieceOf(run[i])) return false;
  return true;
}

/// Which points are one. Asks their blocks and values before, and counts those that differ.
class Joining {
 public:
  Joining(const CellMesh& mesh, const BlocksOfPoints& blocks)
      : blocks_(blocks),
        values_(mesh, blocks.block),
        differs_(mesh.points.size()),
        isApart_(mesh.points.size()) {}

  /// Whether their blocks let them be one.
  [[nodiscard]] bool mayJoin(VertexId a, VertexId b) {
    assert(a < isApart_.size() && b < isApart_.size());
    const std::vector<std::int32_t>& block = blocks_.block;
    if (block.empty() || block[a] == block[b]) return true;
    blocksMeet_ = true;
    const auto pair = std::minmax({block[a], block[b]});
    const bool differ = !values_.agree(a, b);
    if (differ) differing_.insert(pair);
    if (blocks_.apart ? blocks_.apart->contains(pair) : differ) {
      isApart_[std::max(a, b)] = true;
      return false;
    }
    if (differ) differs_[std::max(a, b)] = true;
    return true;
  }

  /// Unites each set of the run's points with the first one, all of whose points it may join.
  void uniteAll(std::span<const VertexId> run, PointSets& sets) {
    if (blocks_.block.empty()) {
      for (const VertexId v : run) sets.unite(run.front(), v);
      return;
    }
    if (run.size() > kMostAtOnePlace) return;
    std::map<VertexId, std::vector<VertexId>> given;  // by their earliest point
    for (const VertexId v : run) given[sets.find(v)].push_back(v);
    std::vector<std::vector<VertexId>> united;
    for (const auto& [first, more] : given) {
      const auto into =
          std::ranges::find_if(united, [&](const auto& known) { return mayJoinAll(known, more); });
      if (into == united.end()) {
        united.push_back(more);
        continue;
      }
      sets.unite(into->front(), first);
      into->insert(into->end(), more.begin(), more.end());
    }
  }

  void tell(PointSets& sets, JoinedPieces& out) const {
    for (VertexId v = 0; v < differs_.size(); ++v) {
      const bool isJoined = sets.find(v) != v;
      out.differingPoints += isJoined && differs_[v] ? 1 : 0;
      out.blockPoints += !isJoined && isApart_[v] ? 1 : 0;
    }
    out.blocksMeet = blocksMeet_;
    out.differing = differing_;
  }

 private:
  /// More points of blocks stay as they are: so many blocks meet nowhere.
  static constexpr std::size_t kMostAtOnePlace = 1024;

  /// Asks all pairs, so that all that differ are known.
  bool mayJoinAll(std::span<const VertexId> known, std::span<const VertexId> more) {
    bool out = true;
    for (const VertexId a : known)
      for (const VertexId b : more) out = mayJoin(a, b) && out;
    return out;
  }

  const BlocksOfPoints& blocks_;
  PointValues values_;
  std::vector<bool> differs_, isApart_;
  bool blocksMeet_ = false;
  NumberPairs differing_;
};

double diagonalOf(const std::vector<Position>& points) {
  Position low{}, high{};
  for (std::size_t i = 0; i < points.size(); ++i)
    for (std::size_t a = 0; a < 3; ++a) {
      low[a] = i == 0 ? points[i][a] : std::min(low[a], points[i][a]);
      high[a] = i == 0 ? points[i][a] : std::max(high[a], points[i][a]);
    }
  return std::hypot(high[0] - low[0], high[1] - low[1], high[2] - low[2]);
}

/// False: the ids are none that hold for all pieces, and nothing is joined.
bool uniteByIds(const CellMesh& mesh, const PieceOf& pieceOf, Joining& joining, PointSets& sets) {
  if (mesh.pointIds.size() != mesh.points.size()) return false;
  const Runs runs(mesh.points.size(),
                  [&](VertexId a, VertexId b) { return mesh.pointIds[a] < mesh.pointIds[b]; });
  const double near = kSamePlace * diagonalOf(mesh.points);
  bool sound = true, any = false;
  runs.each([&](std::span<const VertexId> run) {
    const Position& p = mesh.points[run.front()];
    any = true;
    sound = sound && everyPieceOnce(run, pieceOf);
    for (const VertexId v : run) {
      const Position& q = mesh.points[v];
      sound = sound && std::hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]) <= near;
    }
  });
  if (!sound || !any) return false;
  runs.each([&](std::span<const VertexId> run) { joining.uniteAll(run, sets); });
  return true;
}

/// Before one another by their coordinates, bit by bit but for the sign of 0: an order of NaNs,
/// too, which are refused later.
bool isBefore(const Position& a, const Position& b) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::strong_ordering order = std::strong_order(a[axis] + 0.0, b[axis] + 0.0);
    if (order != 0) return order < 0;
  }
  return false;
}

/// Where a piece has several points at one place, faces decide which belong together. Two cells of
/// different pieces that have all corners of a face at the same places are neighbours. Each point
/// of one is then that of the other at its place.
class Neighbours {
 public:
  /// `runs` are the points at one place, where there are several.
  template <class AllRuns>
  Neighbours(const CellMesh& mesh, const PieceOf& pieceOf, const AllRuns& runs)
      : mesh_(mesh), pieceOf_(pieceOf), run_(mesh.points.size()) {
    runs.each([&](std::span<const VertexId> run) {
      for (const VertexId v : run) run_[v] = run;
    });
    for (std::size_t c = 0; c < mesh.cells(); ++c) addFaces(c);
  }

  void uniteIn(Joining& joining, PointSets& sets) const {
    for (const auto& [corners, sides] : faces_) {
      // Three or more are cells that lie in one another; two of one piece are neighbours already.
      if (sides.size() != 2) continue;
      for (const VertexId a : mesh_.cell(sides[0]))
        for (const VertexId b : mesh_.cell(sides[1]))
          if (a != kGhost && b != kGhost && mayBeOne(a, b, joining, sets)) sets.unite(a, b);
    }
  }

 private:
  /// Whether they are at one place, and no set gets two points of one piece, or other values.
  [[nodiscard]] bool mayBeOne(VertexId a, VertexId b, Joining& joining, PointSets& sets) const {
    if (run_[a].empty() || run_[a].data() != run_[b].data()) return false;
    const VertexId setA = sets.find(a), setB = sets.find(b);
    for (const VertexId m : run_[a])
      for (const VertexId n : run_[a])
        if (m != n && sets.find(m) == setA && sets.find(n) == setB &&
            (pieceOf_(m) == pieceOf_(n) || !joining.mayJoin(m, n)))
          return false;
    return true;
  }

  void addFaces(std::size_t cell) {
    const std::span<const VertexId> ids = mesh_.cell(cell);
    const CellShape shape = shapeOf(mesh_.types[cell]);
    if (shape.corners > ids.size()) return;
    for (const ShapeFace& face : shape.faces) {
      std::vector<VertexId> corners;
      for (std::size_t k = 0; k < face.corners; ++k) {
        const VertexId v = ids[face.corner[k]];
        if (v != kGhost && !run_[v].empty()) corners.push_back(run_[v].front());
      }
      if (corners.size() != face.corners) continue;
      std::ranges::sort(corners);
      faces_[corners].push_back(cell);
    }
  }

  const CellMesh& mesh_;
  const PieceOf& pieceOf_;
  std::vector<std::span<const VertexId>> run_;  ///< of each point; empty: it is alone at its place
  std::map<std::vector<VertexId>, std::vector<std::size_t>> faces_;  ///< cells, by corners' places
};

/// Unites the points in each run where no piece has two; elsewhere faces decide.
template <class Less>
void uniteRuns(const CellMesh& mesh, const PieceOf& pieceOf, const Less& less, Joining& joining,
               PointSets& sets) {
  const Runs runs(mesh.points.size(), less);
  bool isClear = true;
  runs.each([&](std::span<const VertexId> run) {
    everyPieceOnce(run, pieceOf) ? joining.uniteAll(run, sets) : static_cast<void>(isClear = false);
  });
  if (!isClear) Neighbours(mesh, pieceOf, runs).uniteIn(joining, sets);
}

/// The points at exactly the same place, and those nearby where the pieces fit together.
PointSets unitedByPlaces(const CellMesh& mesh, const PieceOf& pieceOf, Joining& joining,
                         JoinedPieces& out) {
  PointSets exact(mesh.points.size());
  uniteRuns(
      mesh, pieceOf,
      [&](VertexId a, VertexId b) { return isBefore(mesh.points[a], mesh.points[b]); }, joining,
      exact);
  const NearPoints nearby = nearPoints(mesh, pieceOf);
  PointSets near = exact;
  uniteRuns(
      mesh, pieceOf, [&](VertexId a, VertexId b) { return nearby.groups[a] < nearby.groups[b]; },
      joining, near);
  for (VertexId v = 0; v < mesh.points.size(); ++v)
    out.nearPoints += near.find(v) != v && exact.find(v) == v ? 1 : 0;
  out.apartPoints = nearby.apart;
  return near;
}

/// Fills in what the point of its own piece has not.
void takeMissing(CellMesh& mesh, VertexId into, VertexId from) {
  for (MeshField& field : mesh.fields) {
    if (isCellField(field)) continue;
    for (std::size_t c = 0; c < field.components; ++c) {
      double& value = field.values[into * std::size_t{field.components} + c];
      if (std::isnan(value)) value = field.values[from * std::size_t{field.components} + c];
    }
  }
}

/// Leaves the points that keep their names, and gives them new ones: the cells', too.
void compact(CellMesh& mesh, std::vector<VertexId>& names) {
  const std::size_t before = names.size();
  VertexId count = 0;
  for (VertexId v = 0; v < before; ++v) {
    assert(names[v] <= v);
    if (names[v] != v) {
      names[v] = names[names[v]];  // an earlier point, which has its new name
      continue;
    }
    assert(count <= v);
    mesh.points[count] = mesh.points[v];
    if (!mesh.pointIds.empty()) mesh.pointIds[count] = mesh.pointIds[v];
    for (MeshField& field : mesh.fields)
      if (const std::size_t n = field.components; !isCellField(field))
        std::copy_n(field.values.begin() + static_cast<std::ptrdiff_t>(v * n), n,
                    field.values.begin() + static_cast<std::ptrdiff_t>(count * n));
    names[v] = count++;
  }
  mesh.points.resize(count);
  if (!mesh.pointIds.empty()) mesh.pointIds.resize(count);
  for (MeshField& field : mesh.fields)
    if (!isCellField(field)) field.values.resize(std::size_t{count} * field.components);
  mesh.renamePoints(names);
}

}  // namespace

JoinedPieces joinPieces(CellMesh& mesh, std::span<const VertexId> pieceEnds,
                        const BlocksOfPoints& blocks) {
  assert(std::ranges::is_sorted(pieceEnds));
  assert(mesh.pointIds.empty() || mesh.pointIds.size() == mesh.points.size());
  JoinedPieces out;
  if (pieceEnds.size() < 2) return out;
  assert(pieceEnds.back() == mesh.points.size());
  const PieceOf pieceOf(pieceEnds);
  PointSets sets(mesh.points.size());
  Joining joining(mesh, blocks);
  out.byIds = uniteByIds(mesh, pieceOf, joining, sets);
  if (!out.byIds) sets = unitedByPlaces(mesh, pieceOf, joining, out);
  joining.tell(sets, out);
  std::vector<VertexId> names(mesh.points.size());
  for (VertexId v = 0; v < names.size(); ++v) {
    names[v] = sets.find(v);
    if (names[v] != v) ++out.points, takeMissing(mesh, names[v], v);
  }
  if (out.points > 0) compact(mesh, names);
  return out;
}

}  // namespace qtet
