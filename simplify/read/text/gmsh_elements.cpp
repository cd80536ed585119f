#include "simplify/read/text/gmsh_elements.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <map>
#include <vector>

#include "simplify/split/higher_cells.h"

namespace qtet {
namespace {

// Gmsh's edge nodes: https://gmsh.info/doc/texinfo/gmsh.html#Node-ordering; VTK's: cell_shapes.cpp.
constexpr std::uint16_t kTetrahedron10[] = {0, 1, 2, 3, 4, 5, 6, 7, 9, 8};
constexpr std::uint16_t kHexahedron20[] = {0,  1, 2,  3,  4,  5,  6,  7,  8,  11,
                                           13, 9, 16, 18, 19, 17, 10, 12, 14, 15};
constexpr std::uint16_t kHexahedron27[] = {0,  1,  2,  3,  4,  5,  6,  7,  8,  11, 13, 9,  16, 18,
                                           19, 17, 10, 12, 14, 15, 22, 23, 21, 24, 20, 25, 26};
constexpr std::uint16_t kPrism15[] = {0, 1, 2, 3, 4, 5, 6, 9, 7, 12, 14, 13, 8, 10, 11};
constexpr std::uint16_t kPrism18[] = {0, 1, 2, 3, 4, 5, 6, 9, 7, 12, 14, 13, 8, 10, 11, 15, 17, 16};
constexpr std::uint16_t kPyramid13[] = {0, 1, 2, 3, 4, 5, 8, 10, 6, 7, 9, 11, 12};
constexpr std::uint16_t kPyramid14[] = {0, 1, 2, 3, 4, 5, 8, 10, 6, 7, 9, 11, 12, 13};

/// Gmsh's order of nodes of any degree, as places from corner 0 on: corners, edges, faces and the
/// inside. Faces and the inside each follow this same order.
class GmshOrder {
 public:
  std::vector<NodePlace> places;

  void triangle(int n, const std::array<NodePlace, 3>& c) {
    if (add(n, c)) return;
    edges(n, c, {{0, 1}, {1, 2}, {2, 0}});
    if (n >= 3) triangle(n - 3, inner(n, c));
  }
  void quadrilateral(int n, const std::array<NodePlace, 4>& c) {
    if (add(n, c)) return;
    edges(n, c, {{0, 1}, {1, 2}, {2, 3}, {3, 0}});
    if (n >= 2)
      quadrilateral(n - 2, {between(n, c[0], c[2], 1), between(n, c[1], c[3], 1),
                            between(n, c[2], c[0], 1), between(n, c[3], c[1], 1)});
  }
  void tetrahedron(int n, const std::array<NodePlace, 4>& c) {
    if (add(n, c)) return;
    edges(n, c, {{0, 1}, {1, 2}, {2, 0}, {3, 0}, {3, 2}, {3, 1}});
    for (const auto& f : std::initializer_list<std::array<std::size_t, 3>>{
             {0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {3, 1, 2}}) {
      if (n >= 3) triangle(n - 3, inner(n, std::array{c[f[0]], c[f[1]], c[f[2]]}));
    }
    if (n >= 4) tetrahedron(n - 4, inner(n, c));
  }
  void hexahedron(int n, const std::array<NodePlace, 8>& c) {
    if (add(n, c)) return;
    edges(n, c,
          {{0, 1},
           {0, 3},
           {0, 4},
           {1, 2},
           {1, 5},
           {2, 3},
           {2, 6},
           {3, 7},
           {4, 5},
           {4, 7},
           {5, 6},
           {6, 7}});
    if (n < 2) return;
    for (const auto& f : std::initializer_list<std::array<std::size_t, 4>>{
             {0, 3, 2, 1}, {0, 1, 5, 4}, {0, 4, 7, 3}, {1, 2, 6, 5}, {2, 3, 7, 6}, {4, 5, 6, 7}})
      faceInside(n, {c[f[0]], c[f[1]], c[f[2]], c[f[3]]});
    std::array<NodePlace, 8> in{};
    for (std::size_t k = 0; k < 8; ++k)
      in[k] = between(n, c[k], c[k < 4 ? (k + 2) % 4 + 4 : (k + 2) % 4], 1);
    hexahedron(n - 2, in);
  }
  /// The inside goes up through the layers at one node of the triangle after the other.
  void prism(int n, const std::array<NodePlace, 6>& c) {
    (void)add(n, c);
    edges(n, c, {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 4}, {2, 5}, {3, 4}, {3, 5}, {4, 5}});
    for (const auto& f : std::initializer_list<std::array<std::size_t, 3>>{{0, 2, 1}, {3, 4, 5}})
      triangle(n - 3, inner(n, std::array{c[f[0]], c[f[1]], c[f[2]]}));
    for (const auto& f : std::initializer_list<std::array<std::size_t, 4>>{
             {0, 1, 4, 3}, {0, 3, 5, 2}, {1, 2, 5, 4}})
      faceInside(n, {c[f[0]], c[f[1]], c[f[2]], c[f[3]]});
    GmshOrder across;
    across.triangle(n - 3, inner(n, std::array{c[0], c[1], c[2]}));
    for (const NodePlace& place : across.places) {
      places.push_back({place[0], place[1], 1});
      places.push_back({place[0], place[1], n - 1});
      for (int layer = 2; layer < n - 1; ++layer) places.push_back({place[0], place[1], layer});
    }
  }
  void pyramid(int n, const std::array<NodePlace, 5>& c) {
    if (add(n, c)) return;
    edges(n, c, {{0, 1}, {0, 3}, {0, 4}, {1, 2}, {1, 4}, {2, 3}, {2, 4}, {3, 4}});
    for (const auto& f : std::initializer_list<std::array<std::size_t, 3>>{
             {0, 1, 4}, {3, 0, 4}, {1, 2, 4}, {2, 3, 4}}) {
      if (n >= 3) triangle(n - 3, inner(n, std::array{c[f[0]], c[f[1]], c[f[2]]}));
    }
    if (n >= 2) faceInside(n, {c[0], c[3], c[2], c[1]});
    const auto [x, y, z] = c[0];
    const int low = 1, high = n - 2;
    if (n >= 3)
      pyramid(n - 3, {{{x + low, y + low, z + 1},
                       {x + high, y + low, z + 1},
                       {x + high, y + high, z + 1},
                       {x + low, y + high, z + 1},
                       {x + low, y + low, z + high}}});
  }

 private:
  /// The corners; true: there is nothing else, as all are one node.
  bool add(int n, std::span<const NodePlace> corners) {
    for (const NodePlace& corner : corners.first(n == 0 ? 1 : corners.size()))
      places.push_back(corner);
    return n == 0;
  }
  /// `steps` of n from a to b.
  static NodePlace between(int n, const NodePlace& a, const NodePlace& b, int steps) {
    NodePlace out{};
    for (std::size_t k = 0; k < 3; ++k) out[k] = a[k] + (b[k] - a[k]) / n * steps;
    return out;
  }
  void edges(int n, std::span<const NodePlace> c,
             std::initializer_list<std::array<std::size_t, 2>> ends) {
    for (const auto& [a, b] : ends)
      for (int step = 1; step < n; ++step) places.push_back(between(n, c[a], c[b], step));
  }
  void faceInside(int n, const std::array<NodePlace, 4>& c) {
    quadrilateral(n - 2, {between(n, c[0], c[2], 1), between(n, c[1], c[3], 1),
                          between(n, c[2], c[0], 1), between(n, c[3], c[1], 1)});
  }
  /// A simplex's corners, each a step along each of its edges.
  template <std::size_t kCount>
  static std::array<NodePlace, kCount> inner(int n, const std::array<NodePlace, kCount>& c) {
    std::array<NodePlace, kCount> out = c;
    for (std::size_t a = 0; a < kCount; ++a)
      for (std::size_t b = 0; b < kCount; ++b)
        for (std::size_t k = 0; k < 3; ++k) out[a][k] += (c[b][k] - c[a][k]) / n;
    return out;
  }
};

std::vector<NodePlace> gmshPlaces(std::uint8_t type, int n) {
  assert(n >= 1 && n <= kMaxDegree);
  GmshOrder order;
  if (type == kLagrangeTetrahedronCell)
    order.tetrahedron(n, {{{0, 0, 0}, {n, 0, 0}, {0, n, 0}, {0, 0, n}}});
  else if (type == kLagrangeWedgeCell)
    order.prism(n, {{{0, 0, 0}, {n, 0, 0}, {0, n, 0}, {0, 0, n}, {n, 0, n}, {0, n, n}}});
  else if (type == kLagrangePyramidCell)
    order.pyramid(n, {{{0, 0, 0}, {n, 0, 0}, {n, n, 0}, {0, n, 0}, {0, 0, n}}});
  else
    order.hexahedron(
        n,
        {{{0, 0, 0}, {n, 0, 0}, {n, n, 0}, {0, n, 0}, {0, 0, n}, {n, 0, n}, {n, n, n}, {0, n, n}}});
  return std::move(order.places);
}

/// An element of higher degree as a Lagrange cell.
GmshElement higherElement(std::uint8_t type, int degree) {
  static std::map<std::pair<std::uint8_t, int>, std::vector<std::uint16_t>> orders;
  std::vector<std::uint16_t>& nodeOf = orders[{type, degree}];
  const Degrees degrees = {degree, degree, degree};
  const HigherCell& cell = higherCell(type, degrees);
  if (nodeOf.empty()) {
    const std::vector<NodePlace> places = gmshPlaces(type, degree);
    assert(places.size() == cell.places.size());
    for (const NodePlace& place : cell.places)
      nodeOf.push_back(
          static_cast<std::uint16_t>(std::ranges::find(places, place) - places.begin()));
  }
  return {static_cast<std::uint32_t>(cell.places.size()), type, nodeOf};
}

/// Gmsh's numbers of complete elements of higher degree, which ascend with it (GmshDefines.h). Type
/// 0 is of lower dimension: only its number of nodes counts.
constexpr std::int64_t kFirstLine = 62, kFirstTriangle = 42;
struct Run {
  std::int64_t first, last;
  std::uint8_t type;
  int degree;  ///< of the first
};
constexpr Run kRuns[] = {{29, 31, kLagrangeTetrahedronCell, 3},
                         {71, 75, kLagrangeTetrahedronCell, 6},
                         {90, 91, kLagrangeWedgeCell, 3},
                         {106, 110, kLagrangeWedgeCell, 5},
                         {92, 98, kLagrangeHexahedronCell, 3},
                         {118, 124, kLagrangePyramidCell, 3},
                         {kFirstLine, 66, 0, 6},
                         {kFirstTriangle, 46, 0, 6},
                         {47, 51, 0, 6}};

/// The complete cell's nodes.
std::uint32_t nodesOf(std::uint8_t type, std::uint32_t degree) {
  const std::uint32_t n = degree + 1, inTriangle = n * (n + 1) / 2;
  switch (type) {
    case kLagrangeTetrahedronCell: return inTriangle * (n + 2) / 3;
    case kLagrangeWedgeCell: return inTriangle * n;
    case kLagrangePyramidCell: return inTriangle * (2 * n + 1) / 3;
    default: return n * n * n;
  }
}

std::uint8_t lagrangeOf(std::uint8_t linear) {
  switch (linear) {
    case kTetrahedronCell: return kLagrangeTetrahedronCell;
    case kHexahedronCell: return kLagrangeHexahedronCell;
    case kWedgeCell: return kLagrangeWedgeCell;
    case kPyramidCell: return kLagrangePyramidCell;
    default: return 0;
  }
}

}  // namespace

GmshElement higherGmshElement(std::uint8_t linear, std::uint32_t nodes) {
  const std::uint8_t type = lagrangeOf(linear);
  for (const Run& run : kRuns) {
    if (type == 0 || run.type != type) continue;
    for (std::int64_t number = run.first; number <= run.last; ++number) {
      const auto degree = static_cast<int>(number - run.first) + run.degree;
      if (nodesOf(type, static_cast<std::uint32_t>(degree)) == nodes)
        return higherElement(type, degree);
    }
  }
  return {};
}

GmshElement gmshElement(std::int64_t number) {
  switch (number) {
    case 1: return {2};
    case 2: return {3};
    case 3: return {4};
    case 4: return {4, kTetrahedronCell};
    case 5: return {8, kHexahedronCell};
    case 6: return {6, kWedgeCell};
    case 7: return {5, kPyramidCell};
    case 8: return {3};
    case 9: return {6};
    case 10: return {9};
    case 11: return {10, kQuadraticTetrahedronCell, kTetrahedron10};
    case 12: return {27, kTriquadraticHexahedronCell, kHexahedron27};
    case 13: return {18, kBiquadraticQuadraticWedgeCell, kPrism18};
    case 14: return {14, kBiquadraticPyramidCell, kPyramid14};
    case 15: return {1};
    case 16: return {8};
    case 17: return {20, kQuadraticHexahedronCell, kHexahedron20};
    case 18: return {15, kQuadraticWedgeCell, kPrism15};
    case 19: return {13, kQuadraticPyramidCell, kPyramid13};
    case 20: return {9};
    case 21: return {10};
    case 22: return {12};
    case 23: return {15};
    case 24: return {15};
    case 25: return {21};
    case 26: return {4};
    case 27: return {5};
    case 28: return {6};
    case 36: return {16};
    case 37: return {25};
    case 38: return {36};
    default: break;
  }
  for (const Run& run : kRuns) {
    const auto degree = static_cast<int>(number - run.first) + run.degree;
    if (number < run.first || number > run.last) continue;
    if (run.type != 0) return higherElement(run.type, degree);
    const auto n = static_cast<std::uint32_t>(degree) + 1;
    return {run.first == kFirstLine ? n : run.first == kFirstTriangle ? n * (n + 1) / 2 : n * n};
  }
  return {};
}

}  // namespace qtet
