#include "simplify/read/parts/near_points.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>
#include <span>

#include "simplify/mesh/split_mix64.h"
#include "simplify/split/each_face.h"

namespace qtet {
namespace {

/// A number that looks random for each set of corners.
std::uint64_t hashOf(std::span<const VertexId> corners) {
  std::uint64_t sum = 0;
  for (const VertexId v : corners) sum += SplitMix64(v).next();
  return sum;
}

/// Whether each point has a face of one cell only. Two cells' faces cancel out in the sum of a
/// point; others do by a chance of 2^-64.
std::vector<bool> onSurface(const CellMesh& mesh) {
  std::vector<std::uint64_t> sums(mesh.points.size());
  for (std::size_t c = 0; c < mesh.cells(); ++c)
    forEachFace(mesh, c, [&](std::span<const VertexId> corners) {
      const std::uint64_t hash = hashOf(corners);
      for (const VertexId v : corners) sums[v] ^= hash;
    });
  std::vector<bool> out(sums.size());
  for (std::size_t v = 0; v < sums.size(); ++v) out[v] = sums[v] != 0;
  return out;
}

double distance(const Position& a, const Position& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

std::vector<double> shortestEdges(const CellMesh& mesh) {
  std::vector<double> out(mesh.points.size(), std::numeric_limits<double>::infinity());
  for (std::size_t c = 0; c < mesh.cells(); ++c)
    forEachFace(mesh, c, [&](std::span<const VertexId> corners) {
      for (std::size_t i = 0; i < corners.size(); ++i) {
        const VertexId a = corners[i], b = corners[i + 1 == corners.size() ? 0 : i + 1];
        if (a == b) continue;
        const double length = distance(mesh.points[a], mesh.points[b]);
        out[a] = std::min(out[a], length), out[b] = std::min(out[b], length);
      }
    });
  return out;
}

std::vector<VertexId> groupsOf(const CellMesh& mesh, const PieceOf& pieceOf) {
  const std::vector<bool> isOnSurface = onSurface(mesh);
  const std::vector<double> edges = shortestEdges(mesh);
  // in the order along a line that is askew to all axes: seams are often planes across one
  constexpr Position kAlong{0.5570860145311556, 0.7427813527082074, 0.3713906763541037};
  std::vector<std::pair<double, VertexId>> order;
  for (VertexId v = 0; v < mesh.points.size(); ++v) {
    const Position& p = mesh.points[v];
    const double along = p[0] * kAlong[0] + p[1] * kAlong[1] + p[2] * kAlong[2];
    if (isOnSurface[v] && std::isfinite(along)) order.emplace_back(along, v);
  }
  std::ranges::sort(order);
  PointSets sets(mesh.points.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    const VertexId v = order[i].second;
    const double near = kNearShare * edges[v];
    for (std::size_t k = i + 1; k < order.size() && order[k].first - order[i].first <= near; ++k) {
      const VertexId other = order[k].second;
      if (distance(mesh.points[v], mesh.points[other]) <=
              std::min(near, kNearShare * edges[other]) &&
          pieceOf(v) != pieceOf(other))
        sets.unite(v, other);
    }
  }
  std::vector<VertexId> out(mesh.points.size());
  for (VertexId v = 0; v < out.size(); ++v) out[v] = sets.find(v);
  return out;
}

/// The groups of a face's corners; empty if one is in no group.
std::vector<VertexId> namesOf(std::span<const VertexId> corners,
                              const std::vector<VertexId>& groups,
                              const std::vector<bool>& isShared) {
  std::vector<VertexId> out;
  for (const VertexId v : corners) {
    if (!isShared[v]) return {};
    out.push_back(groups[v]);
  }
  return out;
}

/// The groups at which a face of one piece meets one of another.
std::vector<bool> closingGroups(const CellMesh& mesh, const PieceOf& pieceOf,
                                const std::vector<VertexId>& groups) {
  std::vector<bool> isShared(groups.size());
  for (VertexId v = 0; v < groups.size(); ++v)
    if (groups[v] != v) isShared[v] = isShared[groups[v]] = true;
  std::vector<std::pair<std::uint64_t, std::size_t>> sides;  // hash of a face, piece
  const auto forEachSide = [&](const auto& visit) {
    for (std::size_t c = 0; c < mesh.cells(); ++c)
      forEachFace(mesh, c, [&](std::span<const VertexId> corners) {
        const std::vector<VertexId> names = namesOf(corners, groups, isShared);
        if (!names.empty()) visit(names, pieceOf(corners.front()));
      });
  };
  forEachSide([&](const std::vector<VertexId>& names, std::size_t piece) {
    sides.emplace_back(hashOf(names), piece);
  });
  std::ranges::sort(sides);
  std::vector<std::uint64_t> met;  // ascending
  for (std::size_t i = 0, end = 0; i < sides.size(); i = end) {
    while (end < sides.size() && sides[end].first == sides[i].first) ++end;
    if (sides[i].second != sides[end - 1].second) met.push_back(sides[i].first);
  }
  std::vector<bool> out(groups.size());
  forEachSide([&](const std::vector<VertexId>& names, std::size_t) {
    if (std::ranges::binary_search(met, hashOf(names)))
      for (const VertexId name : names) out[name] = true;
  });
  return out;
}

}  // namespace

NearPoints nearPoints(const CellMesh& mesh, const PieceOf& pieceOf) {
  NearPoints out{groupsOf(mesh, pieceOf)};
  const std::vector<bool> closes = closingGroups(mesh, pieceOf, out.groups);
  for (VertexId v = 0; v < out.groups.size(); ++v) {
    assert(out.groups[v] <= v && closes.size() == out.groups.size());
    VertexId& group = out.groups[v];
    if (group == v || closes[group]) continue;
    if (mesh.points[v] != mesh.points[group]) ++out.apart;
    group = v;
  }
  return out;
}

}  // namespace qtet
