#include "tests/support/solid_check.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <set>
#include <sstream>

#include "tests/support/exact_geometry.h"
#include "tests/support/homology.h"

namespace qtet::testing {
namespace {

/// Corners of the face opposite each corner, counter-clockwise seen from outside a positive cell.
constexpr std::array<std::array<std::size_t, 3>, 4> kFaces{
    {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};

class Sets {
 public:
  explicit Sets(std::size_t n) : parent_(n) { std::iota(parent_.begin(), parent_.end(), 0); }
  std::size_t of(std::size_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(std::size_t a, std::size_t b) { parent_[of(a)] = of(b); }

 private:
  std::vector<std::size_t> parent_;
};

std::array<VertexId, 2> edgeOf(VertexId a, VertexId b) { return {std::min(a, b), std::max(a, b)}; }

/// The rotation of a triangle that begins with its lowest vertex: equal for equal triangles of one
/// sense.
Triangle turned(Triangle t) {
  std::ranges::rotate(t, std::ranges::min_element(t));
  return t;
}

struct Side {
  std::size_t cell;
  Triangle face;
};

class Checker {
 public:
  explicit Checker(const LatticeMesh& mesh) : mesh_(mesh) {}

  SolidReport report() {
    checkCells();
    checkFaces();
    checkBoundary();
    out_.betti = bettiNumbers(mesh_.tetrahedra);
    countBoundaryEuler();
    findSingular();
    countOverlaps();
    countCrossings();
    return std::move(out_);
  }

 private:
  [[nodiscard]] Point point(VertexId v) const {
    return {mesh_.points[v][0], mesh_.points[v][1], mesh_.points[v][2]};
  }
  template <std::size_t N>
  [[nodiscard]] std::array<Point, N> pointsOf(const std::array<VertexId, N>& simplex) const {
    std::array<Point, N> out;
    std::ranges::transform(simplex, out.begin(), [&](VertexId v) { return point(v); });
    return out;
  }
  template <class Simplices>
  [[nodiscard]] std::vector<Box> boxesOf(const Simplices& simplices) const {
    std::vector<Box> out;
    for (const auto& s : simplices) out.push_back(boxOf(pointsOf(s)));
    return out;
  }

  void checkCells() {
    for (const Tetrahedron& t : mesh_.tetrahedra) {
      const std::int64_t volume = volume6Of(point(t[0]), point(t[1]), point(t[2]), point(t[3]));
      out_.notPositive += volume <= 0;
      out_.volume6 += volume;
    }
  }

  void checkFaces() {
    std::map<Triangle, std::vector<Side>> sides;
    for (std::size_t c = 0; c < mesh_.tetrahedra.size(); ++c)
      for (const auto& corners : kFaces) {
        const Tetrahedron& t = mesh_.tetrahedra[c];
        const Triangle face{t[corners[0]], t[corners[1]], t[corners[2]]};
        Triangle key = face;
        std::ranges::sort(key);
        sides[key].push_back({c, face});
      }
    Sets parts(mesh_.tetrahedra.size());
    for (const auto& [key, at] : sides) {
      out_.facesOfThree += at.size() > 2;
      if (at.size() == 1) boundary_.push_back(at[0].face);
      if (at.size() != 2) continue;
      out_.facesOneSided += turned(at[0].face) == turned(at[1].face);
      parts.join(at[0].cell, at[1].cell);
    }
    for (std::size_t c = 0; c < mesh_.tetrahedra.size(); ++c)
      out_.faceComponents += parts.of(c) == c;
  }

  void checkBoundary() {
    const auto ordered = [](std::vector<Triangle> triangles) {
      std::ranges::transform(triangles, triangles.begin(), turned);
      std::ranges::sort(triangles);
      return triangles;
    };
    out_.boundaryAgrees = ordered(boundary_) == ordered(mesh_.boundary);
  }

  void countBoundaryEuler() {
    Sets parts(mesh_.points.size());
    std::set<VertexId> vertices;
    std::set<std::array<VertexId, 2>> edges;
    for (const Triangle& t : boundary_)
      for (std::size_t i = 0; i < 3; ++i) {
        parts.join(t[i], t[0]);
        vertices.insert(t[i]);
        edges.insert(edgeOf(t[i], t[(i + 1) % 3]));
      }
    std::map<std::size_t, std::int64_t> euler;
    for (const VertexId v : vertices) ++euler[parts.of(v)];
    for (const auto& e : edges) --euler[parts.of(e[0])];
    for (const Triangle& t : boundary_) ++euler[parts.of(t[0])];
    for (const auto& [part, characteristic] : euler) out_.boundaryEuler.push_back(characteristic);
    std::ranges::sort(out_.boundaryEuler);
  }

  void findSingular() {
    std::map<std::array<VertexId, 2>, int> edges;
    std::map<VertexId, std::vector<std::array<VertexId, 2>>> links;
    for (const Triangle& t : boundary_)
      for (std::size_t i = 0; i < 3; ++i) {
        ++edges[edgeOf(t[i], t[(i + 1) % 3])];
        links[t[i]].push_back({t[(i + 1) % 3], t[(i + 2) % 3]});
      }
    for (const auto& [edge, triangles] : edges)
      if (triangles != 2)
        out_.singularEdges.push_back({std::min(mesh_.points[edge[0]], mesh_.points[edge[1]]),
                                      std::max(mesh_.points[edge[0]], mesh_.points[edge[1]])});
    for (const auto& [vertex, link] : links)
      if (!isOneCircle(link)) out_.singularVertices.push_back(mesh_.points[vertex]);
    std::ranges::sort(out_.singularEdges);
    std::ranges::sort(out_.singularVertices);
  }

  static bool isOneCircle(const std::vector<std::array<VertexId, 2>>& edges) {
    std::map<VertexId, std::size_t> degree, number;
    for (const auto& e : edges)
      for (const VertexId v : e) ++degree[v], number.try_emplace(v, number.size());
    Sets parts(number.size());
    for (const auto& e : edges) parts.join(number[e[0]], number[e[1]]);
    const bool connected = std::ranges::all_of(
        number, [&](const auto& n) { return parts.of(n.second) == parts.of(0); });
    return connected && std::ranges::all_of(degree, [](const auto& d) { return d.second == 2; });
  }

  void countOverlaps() {
    const auto boxes = boxesOf(mesh_.tetrahedra);
    forEachBoxPair(boxes, boxes, [&](std::size_t i, std::size_t j) {
      if (i < j)
        out_.overlaps += insideMeets(pointsOf(mesh_.tetrahedra[i]), pointsOf(mesh_.tetrahedra[j]));
    });
  }

  void countCrossings() {
    const auto boxes = boxesOf(boundary_);
    forEachBoxPair(boxes, boxes, [&](std::size_t i, std::size_t j) {
      if (i < j) out_.crossings += meetElsewhere(boundary_[i], boundary_[j]);
    });
  }

  /// Turned so that the vertices which both have come first, in the same order; returns how many.
  static std::size_t sharedFirst(Triangle& s, Triangle& t) {
    std::size_t shared = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto same = std::ranges::find(t, s[i]);
      if (same == t.end()) continue;
      std::swap(*same, t[shared]);
      std::swap(s[i], s[shared]);
      ++shared;
    }
    return shared;
  }

  [[nodiscard]] bool meetElsewhere(Triangle first, Triangle second) const {
    const std::size_t shared = sharedFirst(first, second);
    const auto s = pointsOf(first), t = pointsOf(second);
    if (shared == 3) return true;
    if (shared == 2) return foldedOnto(s, t[2]);
    // With one vertex in common, what else they have in common reaches one of the edges opposite
    // it.
    if (shared == 1)
      return segmentMeetsTriangle(s[1], s[2], t) || segmentMeetsTriangle(t[1], t[2], s);
    for (std::size_t i = 0; i < 3; ++i)
      if (segmentMeetsTriangle(s[i], s[(i + 1) % 3], t) ||
          segmentMeetsTriangle(t[i], t[(i + 1) % 3], s))
        return true;
    return false;
  }

  /// Whether d lies in the triangle's plane, on the same side of its first edge as its third
  /// vertex: both triangles cover a common part.
  static bool foldedOnto(const std::array<Point, 3>& t, const Point& d) {
    if (sideOf(t[0], t[1], t[2], d) != 0) return false;
    // Seen from a point off the plane, both turn the same way round the edge. One of the axes leads
    // off it.
    for (std::size_t k = 0; k < 3; ++k) {
      Point off = t[0];
      ++off[k];
      if (const int side = sideOf(t[0], t[1], t[2], off); side != 0)
        return sideOf(t[0], t[1], d, off) == side;
    }
    return true;
  }

  const LatticeMesh& mesh_;
  SolidReport out_;
  std::vector<Triangle> boundary_;
};

/// Coordinates times four, so that a barycentre is a point.
constexpr std::int64_t kCorners = 4;

template <class Simplex>
std::vector<Point> cornersOf(const LatticeMesh& mesh, const Simplex& simplex) {
  std::vector<Point> out;
  for (const VertexId v : simplex)
    out.push_back(
        {kCorners * mesh.points[v][0], kCorners * mesh.points[v][1], kCorners * mesh.points[v][2]});
  return out;
}

std::array<Point, 4> cellOf(const std::vector<Point>& corners) {
  return {corners[0], corners[1], corners[2], corners[3]};
}

Point barycentre(const std::vector<Point>& corners) {
  Point sum{};
  for (const Point& p : corners)
    for (std::size_t k = 0; k < 3; ++k) sum[k] += p[k] / kCorners;
  return sum;
}

std::vector<Box> boxesOf(const std::vector<std::vector<Point>>& simplices) {
  std::vector<Box> out;
  for (const auto& s : simplices) out.push_back(boxOf(s));
  return out;
}

}  // namespace

std::string SolidReport::faults() const {
  std::ostringstream out;
  const auto say = [&](std::uint64_t count, const char* what) {
    if (count != 0) out << (out.tellp() > 0 ? "; " : "") << count << " " << what;
  };
  say(notPositive, "cells that are not positive");
  say(facesOfThree, "faces of more than two cells");
  say(facesOneSided, "faces with both cells on one side");
  say(!boundaryAgrees, "boundary that is not the cells'");
  say(overlaps, "pairs of cells that overlap");
  say(crossings, "pairs of boundary triangles that cross or touch");
  return out.str();
}

SolidReport checkSolid(const LatticeMesh& mesh) { return Checker(mesh).report(); }

std::string topologyChange(const SolidReport& now, const SolidReport& original) {
  if (now.betti != original.betti) return "the Betti numbers changed";
  if (now.faceComponents != original.faceComponents)
    return "the cells hang together by faces in another number of parts";
  if (now.boundaryEuler != original.boundaryEuler)
    return "the Euler characteristics of the boundary's parts changed";
  if (now.singularVertices != original.singularVertices) return "the singular vertices changed";
  if (now.singularEdges != original.singularEdges) return "the singular edges changed";
  return "";
}

std::string whatIsOutside(const LatticeMesh& inner, const LatticeMesh& outer) {
  std::vector<std::vector<Point>> cells, outerCells, outerBoundary, barycentres;
  for (const Tetrahedron& t : inner.tetrahedra)
    cells.push_back(cornersOf(inner, t)), barycentres.push_back({barycentre(cells.back())});
  for (const Tetrahedron& t : outer.tetrahedra) outerCells.push_back(cornersOf(outer, t));
  for (const Triangle& t : outer.boundary) outerBoundary.push_back(cornersOf(outer, t));

  std::vector<bool> crossed(cells.size()), held(cells.size());
  forEachBoxPair(boxesOf(cells), boxesOf(outerBoundary), [&](std::size_t c, std::size_t b) {
    if (!crossed[c]) crossed[c] = insideMeets(cellOf(cells[c]), outerBoundary[b]);
  });
  forEachBoxPair(boxesOf(barycentres), boxesOf(outerCells), [&](std::size_t c, std::size_t o) {
    if (!held[c]) held[c] = holds(cellOf(outerCells[o]), barycentres[c][0]);
  });
  for (std::size_t c = 0; c < cells.size(); ++c) {
    if (crossed[c]) return "cell " + std::to_string(c) + " crosses the outer solid's boundary";
    if (!held[c]) return "cell " + std::to_string(c) + " lies outside";
  }
  return "";
}

}  // namespace qtet::testing
