#include "simplify/split/node_order.h"

#include <algorithm>
#include <cassert>

namespace qtet {
namespace {

/// A node's place on a triangle or tetrahedron by its distances from the sides, `degree` in all.
template <std::size_t N>
struct Barycentric {
  std::array<int, N> b{};

  [[nodiscard]] int least() const { return *std::ranges::min_element(b); }
  /// The same node on the simplex that is left without `layers` outer ones.
  [[nodiscard]] Barycentric within(int layers) const {
    Barycentric out = *this;
    for (int& distance : out.b) distance -= layers;
    return out;
  }
};

constexpr int triangleNodes(int degree) { return (degree + 1) * (degree + 2) / 2; }
constexpr int tetrahedronNodes(int degree) { return triangleNodes(degree) * (degree + 3) / 3; }

/// Corners and edges alone: the inner nodes are a triangle of three degrees less.
int triangleNode(int degree, Barycentric<3> node) {
  int before = 0;
  for (; node.least() > 0; degree -= 3) {
    before += 3 * degree;
    node = node.within(1);
  }
  assert(degree >= 0 && node.b[0] + node.b[1] + node.b[2] == degree);
  if (degree == 0) return before;
  for (int corner = 0; corner < 3; ++corner)
    if (node.b[(corner + 2) % 3] == degree) return before + corner;
  before += 3;
  for (int edge = 0; edge < 3; ++edge, before += degree - 1)
    if (node.b[(edge + 1) % 3] == 0) return before + node.b[edge] - 1;
  return before;
}

/// Triangles' inner nodes row by row.
int innerTriangleNode(int degree, int i, int j) { return i + degree * (j - 1) - j * (j + 1) / 2; }

struct NodeEdge {
  int zeroA, zeroB;  ///< the distances that are 0 on it
  int counted;       ///< the distance that numbers its nodes
};
constexpr std::array<NodeEdge, 6> kNodeEdges{
    {{1, 2, 0}, {2, 3, 1}, {0, 2, 3}, {0, 1, 2}, {1, 3, 2}, {0, 3, 2}}};

struct NodeFace {
  int zero;
  std::array<int, 3> distances;  ///< of the triangle's sides
};
constexpr std::array<NodeFace, 4> kNodeFaces{
    {{1, {0, 2, 3}}, {3, {2, 0, 1}}, {0, {2, 1, 3}}, {2, {1, 0, 3}}}};

}  // namespace

int tetrahedronNode(int degree, int i, int j, int k) {
  assert(degree >= 1 && std::min({i, j, k}) >= 0 && i + j + k <= degree);
  Barycentric<4> node{{i, j, k, degree - i - j - k}};
  int before = 0;
  for (; node.least() > 0; degree -= 4) {
    before += tetrahedronNodes(degree) - tetrahedronNodes(degree - 4);
    node = node.within(1);
  }
  assert(degree >= 0 && node.least() == 0);
  if (degree == 0) return before;
  for (int corner = 0; corner < 4; ++corner)
    if (node.b[(corner + 3) % 4] == degree) return before + corner;
  before += 4;
  for (const NodeEdge& edge : kNodeEdges) {
    if (node.b[edge.zeroA] == 0 && node.b[edge.zeroB] == 0)
      return before + node.b[edge.counted] - 1;
    before += degree - 1;
  }
  for (const NodeFace& face : kNodeFaces) {
    // a face's inner nodes follow in the triangle's own order, without its 3 degree outer ones
    if (node.b[face.zero] == 0)
      return before - 3 * degree +
             triangleNode(degree, {{node.b[face.distances[0]], node.b[face.distances[1]],
                                    node.b[face.distances[2]]}});
    before += triangleNodes(degree) - 3 * degree;
  }
  return before;
}

int hexahedronNode(const std::array<int, 3>& degrees, int i, int j, int k) {
  assert(std::ranges::min(degrees) >= 1 && std::min({i, j, k}) >= 0);
  assert(i <= degrees[0] && j <= degrees[1] && k <= degrees[2]);
  const int a = degrees[0] - 1, b = degrees[1] - 1, c = degrees[2] - 1;  // inner nodes of edges
  const bool atI = i == 0 || i == degrees[0], atJ = j == 0 || j == degrees[1],
             atK = k == 0 || k == degrees[2];
  const bool farI = i != 0, farJ = j != 0, farK = k != 0;
  const int column = farI ? (farJ ? 2 : 1) : (farJ ? 3 : 0);
  if (atI && atJ && atK) return column + (farK ? 4 : 0);
  int before = 8;
  if (atJ && atK) return before + (farJ ? a + b : 0) + (farK ? 2 * (a + b) : 0) + i - 1;
  if (atI && atK) return before + (farI ? a : 2 * a + b) + (farK ? 2 * (a + b) : 0) + j - 1;
  before += 4 * (a + b);
  if (atI && atJ) return before + column * c + k - 1;
  before += 4 * c;
  if (atI) return before + (farI ? b * c : 0) + (j - 1) + b * (k - 1);
  before += 2 * b * c;
  if (atJ) return before + (farJ ? a * c : 0) + (i - 1) + a * (k - 1);
  before += 2 * a * c;
  if (atK) return before + (farK ? a * b : 0) + (i - 1) + a * (j - 1);
  before += 2 * a * b;
  return before + (i - 1) + a * ((j - 1) + b * (k - 1));
}

int wedgeNode(const std::array<int, 3>& degrees, int i, int j, int k) {
  assert(std::ranges::min(degrees) >= 1 && std::min({i, j, k}) >= 0);
  assert(i + j <= degrees[0] && k <= degrees[2]);
  const int n = degrees[0], a = n - 1, c = degrees[2] - 1;  // inner nodes of edges
  const bool atI = i == 0, atJ = j == 0, atIJ = i + j == n, atK = k == 0 || k == degrees[2];
  const int column = atI && atJ ? 0 : atJ && atIJ ? 1 : 2;
  const bool isOnColumn = (atI && atJ) || (atJ && atIJ) || (atI && atIJ);
  if (isOnColumn && atK) return column + (k != 0 ? 3 : 0);
  int before = 6;
  if (atK && (atI || atJ || atIJ)) {
    before += k != 0 ? 3 * a : 0;
    return before + (atJ ? i - 1 : atIJ ? a + j - 1 : 2 * a + n - j - 1);
  }
  before += 6 * a;
  if (isOnColumn) return before + column * c + k - 1;
  before += 3 * c;
  const int inner = (a - 1) * a / 2;  // nodes of a triangle
  if (atK) return before + (k != 0 ? inner : 0) + innerTriangleNode(n, i, j);
  before += 2 * inner;
  if (atJ) return before + (i - 1) + a * (k - 1);
  if (atIJ) return before + a * c + (n - i - 1) + a * (k - 1);
  if (atI) return before + 2 * a * c + (n - j - 1) + a * (k - 1);
  return before + 3 * a * c + innerTriangleNode(n, i, j) + inner * (k - 1);
}

}  // namespace qtet
