#include "simplify/read/parts/own_points.h"

#include <algorithm>
#include <cassert>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include "simplify/read/parts/join_pieces.h"
#include "simplify/read/parts/point_sets.h"
#include "simplify/read/parts/point_values.h"

namespace qtet {
namespace {

/// The patches of a mesh, and of which each of its points is.
struct Patches {
  std::vector<VertexId> patch;  ///< one a point, from 0; kGhost: no cell has the point
  VertexId count = 0;
  std::uint64_t points = 0;  ///< of all patches
};

Patches patchesOf(const CellMesh& mesh) {
  PointSets sets(mesh.points.size());
  std::vector<bool> isUsed(mesh.points.size());
  for (std::size_t c = 0; c < mesh.cells(); ++c) {
    VertexId first = kGhost;
    forEachId(mesh.types[c], mesh.cell(c), [&](VertexId v) {
      isUsed[v] = true;
      first == kGhost ? static_cast<void>(first = v) : sets.unite(first, v);
    });
  }
  Patches out{std::vector<VertexId>(mesh.points.size(), kGhost)};
  for (VertexId v = 0; v < mesh.points.size(); ++v) {
    if (!isUsed[v]) continue;
    const VertexId first = sets.find(v);
    assert(first <= v);
    out.patch[v] = first == v ? out.count++ : out.patch[first];
    ++out.points;
  }
  return out;
}

/// Points by their places, those of no cell last.
std::vector<VertexId> byPlace(const CellMesh& mesh, const Patches& patches) {
  std::vector<VertexId> order;
  for (VertexId v = 0; v < mesh.points.size(); ++v)
    if (patches.patch[v] != kGhost) order.push_back(v);
  std::ranges::sort(order, [&](VertexId a, VertexId b) {
    return mesh.points[a] != mesh.points[b] ? mesh.points[a] < mesh.points[b] : a < b;
  });
  return order;
}

void countCoincident(const CellMesh& mesh, const Patches& patches, OwnPoints& out) {
  std::vector<std::int32_t> patch(mesh.points.size());
  std::ranges::transform(patches.patch, patch.begin(),
                         [](VertexId p) { return static_cast<std::int32_t>(p); });
  const PointValues values(mesh, patch);
  VertexId first = kGhost;
  for (const VertexId v : byPlace(mesh, patches)) {
    if (first == kGhost || mesh.points[first] != mesh.points[v]) {
      first = v;
    } else if (patch[first] != patch[v]) {
      ++out.coincident;
      out.differing += values.agree(first, v) ? 0 : 1;
    }
  }
}

/// Puts the points of each patch together, those of no cell at the end. Returns the patches' ends.
std::vector<VertexId> sortPoints(CellMesh& mesh, const Patches& patches) {
  std::vector<VertexId> order(mesh.points.size()), ends(patches.count);
  std::iota(order.begin(), order.end(), VertexId{0});
  std::ranges::sort(order, {}, [&](VertexId v) { return std::pair(patches.patch[v], v); });
  std::vector<VertexId> names(order.size());
  const CellMesh before{mesh.points, {}, {0}, {}, {}, {}, {}, {}, mesh.pointIds};
  for (VertexId v = 0; v < order.size(); ++v) {
    names[order[v]] = v;
    mesh.points[v] = before.points[order[v]];
    if (!mesh.pointIds.empty()) mesh.pointIds[v] = before.pointIds[order[v]];
    if (patches.patch[order[v]] != kGhost) ends[patches.patch[order[v]]] = v + 1;
  }
  assert(!ends.empty());
  ends.back() = static_cast<VertexId>(order.size());
  for (MeshField& field : mesh.fields) {
    if (isCellField(field)) continue;
    const std::vector<double> values = field.values;
    const std::size_t n = field.components;
    assert(values.size() == order.size() * n);
    for (std::size_t v = 0; v < order.size(); ++v)
      std::copy_n(values.begin() + static_cast<std::ptrdiff_t>(order[v] * n), n,
                  field.values.begin() + static_cast<std::ptrdiff_t>(v * n));
  }
  mesh.renamePoints(names);
  return ends;
}

}  // namespace

OwnPoints joinOwnPoints(CellMesh& mesh, OwnJoin how) {
  OwnPoints out;
  Patches patches = patchesOf(mesh);
  if (patches.count < 2 || patches.points / patches.count > kMostPatchPoints) return out;
  countCoincident(mesh, patches, out);
  if (static_cast<double>(out.coincident) <= kMostCoincide * static_cast<double>(patches.points))
    return {};
  assert(out.coincident < patches.points && out.differing <= out.coincident);
  out.patches = patches.count;
  const bool agree =
      static_cast<double>(out.differing) <= kFewDiffer * static_cast<double>(out.coincident);
  if (how == OwnJoin::kNever || (how != OwnJoin::kAlways && !agree)) return out;
  const std::vector<VertexId> ends = sortPoints(mesh, patches);
  BlocksOfPoints blocks;
  const PieceOf pieceOf(ends);
  for (VertexId v = 0; how == OwnJoin::kByValues && v < mesh.points.size(); ++v)
    blocks.block.push_back(static_cast<std::int32_t>(pieceOf(v)) + 1);
  out.joined = joinPieces(mesh, ends, blocks).points;
  return out;
}

}  // namespace qtet
