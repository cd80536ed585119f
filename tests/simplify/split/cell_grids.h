// A unit cube of cells of any kind, and what a set of tetrahedra fills.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <random>
#include <vector>

#include "simplify/mesh/tet_mesh.h"
#include "simplify/mesh/volume_sign.h"
#include "simplify/split/cell_mesh.h"
#include "simplify/split/cell_shapes.h"
#include "simplify/split/higher_cells.h"

namespace qtet::testing {

/// n x n x n hexahedra in [0, 1]^3. Their inner points are moved at random by up to `jitter` of a
/// cell, and all points are numbered at random.
inline CellMesh hexGrid(int n, std::uint32_t seed, double jitter = 0.15) {
  std::mt19937 random(seed);
  const auto side = static_cast<VertexId>(n + 1);
  std::vector<VertexId> names(side * side * side);
  std::iota(names.begin(), names.end(), 0u);
  std::shuffle(names.begin(), names.end(), random);
  CellMesh mesh;
  mesh.pointType = "float64";
  mesh.points.resize(names.size());
  const auto at = [&](VertexId i, VertexId j, VertexId k) {
    return names[i + side * (j + side * k)];
  };
  std::uniform_real_distribution<double> moved(-jitter / n, jitter / n);
  for (VertexId k = 0; k < side; ++k) {
    for (VertexId j = 0; j < side; ++j) {
      for (VertexId i = 0; i < side; ++i) {
        Position p{};
        const std::array<VertexId, 3> place{i, j, k};
        for (std::size_t c = 0; c < 3; ++c) {
          const bool inner = place[c] > 0 && place[c] + 1 < side;
          p[c] = place[c] / static_cast<double>(n) + (inner ? moved(random) : 0);
        }
        mesh.points[at(i, j, k)] = p;
      }
    }
  }
  for (VertexId k = 0; k + 1 < side; ++k) {
    for (VertexId j = 0; j + 1 < side; ++j) {
      for (VertexId i = 0; i + 1 < side; ++i) {
        mesh.addCell(kHexahedronCell,
                     std::array{at(i, j, k), at(i + 1, j, k), at(i + 1, j + 1, k), at(i, j + 1, k),
                                at(i, j, k + 1), at(i + 1, j, k + 1), at(i + 1, j + 1, k + 1),
                                at(i, j + 1, k + 1)});
      }
    }
  }
  return mesh;
}

/// The same points and none of the cells.
inline CellMesh pointsOf(const CellMesh& mesh) {
  CellMesh out;
  out.points = mesh.points;
  out.pointType = mesh.pointType;
  return out;
}

inline VertexId addCentre(CellMesh& mesh, std::span<const VertexId> around) {
  Position p{};
  for (const VertexId v : around) {
    for (std::size_t c = 0; c < 3; ++c)
      p[c] += mesh.points[v][c] / static_cast<double>(around.size());
  }
  mesh.points.push_back(p);
  return static_cast<VertexId>(mesh.points.size() - 1);
}

/// The hexahedra as polyhedra, every other face stored in the opposite sense.
inline CellMesh asPolyhedra(const CellMesh& hexes) {
  CellMesh out = pointsOf(hexes);
  std::size_t turn = 0;
  for (std::size_t i = 0; i < hexes.cells(); ++i) {
    std::vector<VertexId> stream{6};
    for (const ShapeFace& face : shapeOf(kHexahedronCell).faces) {
      std::vector<VertexId> loop;
      for (int k = 0; k < 4; ++k)
        loop.push_back(hexes.cell(i)[face.corner[static_cast<std::size_t>(k)]]);
      if (++turn % 2) std::ranges::reverse(loop);
      stream.push_back(4);
      stream.insert(stream.end(), loop.begin(), loop.end());
    }
    out.addCell(kPolyhedronCell, stream);
  }
  return out;
}

/// A mix: every other hexahedron becomes six pyramids round its centre.
inline CellMesh mixed(const CellMesh& hexes) {
  CellMesh out = pointsOf(hexes);
  for (std::size_t i = 0; i < hexes.cells(); ++i) {
    const auto c = hexes.cell(i);
    if (i % 2 == 0) {
      out.addCell(kHexahedronCell, c);
      continue;
    }
    const VertexId apex = addCentre(out, c);
    for (const ShapeFace& face : shapeOf(kHexahedronCell).faces)
      out.addCell(kPyramidCell, std::array{c[face.corner[3]], c[face.corner[2]], c[face.corner[1]],
                                           c[face.corner[0]], apex});
  }
  return out;
}

/// Every hexahedron as two wedges, cut alike.
inline CellMesh asWedges(const CellMesh& hexes) {
  CellMesh out = pointsOf(hexes);
  for (std::size_t i = 0; i < hexes.cells(); ++i) {
    const auto c = hexes.cell(i);
    out.addCell(kWedgeCell, std::array{c[0], c[2], c[1], c[4], c[6], c[5]});
    out.addCell(kWedgeCell, std::array{c[0], c[3], c[2], c[4], c[7], c[6]});
  }
  return out;
}

/// Cells of a linear kind with the nodes of the curved kind `type`; nodes lie halfway, and
/// neighbours share them.
inline CellMesh curved(const CellMesh& linear, std::uint8_t type) {
  CellMesh out = pointsOf(linear);
  std::map<std::vector<VertexId>, VertexId> nodes;
  const CellShape shape = shapeOf(type);
  const CurvedNodes places = curvedNodesOf(type);
  const auto nodeOf = [&](std::vector<VertexId> around) {
    std::ranges::sort(around);
    const auto at = nodes.find(around);
    return at != nodes.end() ? at->second : nodes[around] = addCentre(out, around);
  };
  for (std::size_t i = 0; i < linear.cells(); ++i) {
    const auto c = linear.cell(i);
    std::vector<VertexId> ids(verticesOf(type), kGhost);
    std::ranges::copy(c, ids.begin());
    for (std::size_t e = 0; e < places.edges.size(); ++e)
      ids[shape.corners + e] = nodeOf({c[places.edges[e][0]], c[places.edges[e][1]]});
    for (std::size_t f = 0; f < shape.faces.size(); ++f) {
      if (places.faceCentre[f] == kNoNode) continue;
      std::vector<VertexId> around;
      for (std::size_t k = 0; k < shape.faces[f].corners; ++k)
        around.push_back(c[shape.faces[f].corner[k]]);
      ids[places.faceCentre[f]] = nodeOf(around);
    }
    if (places.centre != kNoNode) ids[places.centre] = addCentre(out, c);
    out.addCell(type, ids);
  }
  return out;
}

/// The Lagrange cell with a linear one's corners.
inline std::uint8_t lagrangeOf(std::uint8_t linear) {
  return linear == kTetrahedronCell ? kLagrangeTetrahedronCell
         : linear == kWedgeCell     ? kLagrangeWedgeCell
         : linear == kPyramidCell   ? kLagrangePyramidCell
                                    : kLagrangeHexahedronCell;
}

/// Linear cells with the nodes of a Lagrange or Bezier cell of `degree`, evenly spaced; neighbours
/// share them. Without a type: Lagrange cells, each of its own kind.
inline CellMesh higher(const CellMesh& linear, int degree, std::uint8_t type = 0) {
  CellMesh out = pointsOf(linear);
  std::map<std::map<VertexId, int>, VertexId> nodes;  // by how often each corner counts
  const auto nodeOf = [&](std::map<VertexId, int> weights) {
    if (weights.size() == 1) return weights.begin()->first;
    int divisor = 0;
    for (const auto& [corner, weight] : weights) divisor = std::gcd(divisor, weight);
    for (auto& [corner, weight] : weights) weight /= divisor;
    const auto [at, isNew] = nodes.try_emplace(weights, static_cast<VertexId>(out.points.size()));
    if (!isNew) return at->second;
    Position p{};
    double sum = 0;
    for (const auto& [corner, weight] : weights) sum += weight;
    for (const auto& [corner, weight] : weights)
      for (std::size_t c = 0; c < 3; ++c) p[c] += weight / sum * out.points[corner][c];
    out.points.push_back(p);
    return at->second;
  };
  for (std::size_t cell = 0; cell < linear.cells(); ++cell) {
    const auto c = linear.cell(cell);
    const std::uint8_t own = type != 0 ? type : lagrangeOf(linear.types[cell]);
    const std::size_t corners = shapeOf(own).corners;
    const HigherCell& shape = higherCell(own, {degree, degree, degree});
    std::vector<VertexId> ids;
    for (const auto& [i, j, k] : shape.places) {
      std::map<VertexId, int> weights;
      const auto add = [&](std::size_t corner, int weight) {
        if (weight > 0) weights[c[corner]] += weight;
      };
      const std::array<int, 3> across{degree - i - j, i, j};
      for (std::size_t v = 0; v < corners; ++v) {
        const bool right = v % 4 == 1 || v % 4 == 2, back = v % 4 >= 2;
        if (corners == 4)
          add(v, v == 0 ? degree - i - j - k : v == 1 ? i : v == 2 ? j : k);
        else if (corners == 5 && v == 4)
          add(v, k == degree ? 1 : k * (degree - k));
        else if (corners == 5)
          add(v, (right ? i : degree - k - i) * (back ? j : degree - k - j));
        else if (corners == 6)
          add(v, across[v % 3] * (v < 3 ? degree - k : k));
        else
          add(v, (right ? i : degree - i) * (back ? j : degree - j) * (v >= 4 ? k : degree - k));
      }
      ids.push_back(nodeOf(weights));
    }
    out.addCell(own, ids);
  }
  return out;
}

struct Filled {
  double volume = 0;    ///< the sum of the tetrahedra's
  double absolute = 0;  ///< of theirs without sign
  std::size_t notPositive = 0;
  std::size_t facesOfMore = 0;  ///< of more than two tetrahedra
  std::size_t boundary = 0;     ///< triangles
  std::size_t openEdges = 0;    ///< of other than two boundary triangles
  double boundaryArea = 0;
};

inline Filled filledBy(const TetMesh& mesh) {
  Filled out;
  std::map<std::array<VertexId, 3>, int> faces;
  for (const Tetrahedron& t : mesh.tetrahedra) {
    const double volume =
        roundedVolume6(mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]], mesh.points[t[3]]) /
        6;
    out.volume += volume;
    out.absolute += std::abs(volume);
    if (volume <= 0) ++out.notPositive;
    for (std::size_t k = 0; k < 4; ++k) {
      std::array<VertexId, 3> face{t[(k + 1) % 4], t[(k + 2) % 4], t[(k + 3) % 4]};
      std::ranges::sort(face);
      ++faces[face];
    }
  }
  std::map<std::array<VertexId, 2>, int> edges;
  for (const auto& [face, cells] : faces) {
    if (cells > 2) ++out.facesOfMore;
    if (cells != 1) continue;
    ++out.boundary;
    for (std::size_t k = 0; k < 3; ++k)
      ++edges[{std::min(face[k], face[(k + 1) % 3]), std::max(face[k], face[(k + 1) % 3])}];
    Position u{}, v{};
    for (std::size_t c = 0; c < 3; ++c)
      u[c] = mesh.points[face[1]][c] - mesh.points[face[0]][c],
      v[c] = mesh.points[face[2]][c] - mesh.points[face[0]][c];
    out.boundaryArea += std::hypot(u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2],
                                   u[0] * v[1] - u[1] * v[0]) /
                        2;
  }
  for (const auto& [edge, triangles] : edges) {
    if (triangles != 2) ++out.openEdges;
  }
  return out;
}

}  // namespace qtet::testing
