#include "simplify/split/higher_cells.h"

#include <cassert>
#include <cmath>
#include <map>

#include "simplify/split/node_order.h"

namespace qtet {
namespace {

enum class Shape { kTetrahedron, kWedge, kHexahedron, kPyramid };

Shape shapeOfHigher(std::uint8_t type) {
  if (type == kLagrangePyramidCell) return Shape::kPyramid;
  if (type == kLagrangeTetrahedronCell || type == kBezierTetrahedronCell)
    return Shape::kTetrahedron;
  return type == kLagrangeWedgeCell || type == kBezierWedgeCell ? Shape::kWedge
                                                                : Shape::kHexahedron;
}

std::size_t nodesOf(Shape shape, const Degrees& d) {
  const auto [a, b, c] = std::array{std::size_t(d[0]), std::size_t(d[1]), std::size_t(d[2])};
  assert(std::ranges::min(d) >= 1 && std::ranges::max(d) <= kMaxDegree);
  if (shape == Shape::kTetrahedron) return (a + 1) * (a + 2) * (a + 3) / 6;
  if (shape == Shape::kPyramid) return (a + 1) * (a + 2) * (2 * a + 3) / 6;
  if (shape == Shape::kWedge) return (a + 1) * (a + 2) / 2 * (c + 1);
  return (a + 1) * (b + 1) * (c + 1);
}

/// The corners, then the others, from the base upwards.
std::uint16_t pyramidNodeAt(int n, const NodePlace& place) {
  const std::array<NodePlace, 5> corners{{{0, 0, 0}, {n, 0, 0}, {n, n, 0}, {0, n, 0}, {0, 0, n}}};
  std::size_t before = 0, cornersBefore = 0;
  for (std::size_t c = 0; c < corners.size(); ++c) {
    if (place == corners[c]) return static_cast<std::uint16_t>(c);
    const auto upwards = [](const NodePlace& p) { return std::array{p[2], p[1], p[0]}; };
    cornersBefore += upwards(corners[c]) < upwards(place) ? 1 : 0;
  }
  const auto side = [n](int height) { return static_cast<std::size_t>(n - height + 1); };
  for (int height = 0; height < place[2]; ++height) before += side(height) * side(height);
  before +=
      static_cast<std::size_t>(place[1]) * side(place[2]) + static_cast<std::size_t>(place[0]);
  return static_cast<std::uint16_t>(before - cornersBefore + corners.size());
}

std::uint16_t nodeAt(Shape shape, const Degrees& d, int i, int j, int k) {
  if (shape == Shape::kPyramid) return pyramidNodeAt(d[0], {i, j, k});
  return static_cast<std::uint16_t>(shape == Shape::kTetrahedron ? tetrahedronNode(d[0], i, j, k)
                                    : shape == Shape::kWedge     ? wedgeNode(d, i, j, k)
                                                                 : hexahedronNode(d, i, j, k));
}

bool isInside(Shape shape, const Degrees& d, int i, int j, int k) {
  if (shape == Shape::kTetrahedron) return i + j + k <= d[0];
  if (shape == Shape::kPyramid) return k <= d[0] && i <= d[0] - k && j <= d[0] - k;
  return i <= d[0] && j <= d[1] && k <= d[2] && (shape == Shape::kHexahedron || i + j <= d[0]);
}

class Builder {
 public:
  Builder(Shape shape, const Degrees& degrees) : shape_(shape) {
    cell_.degrees = degrees;
    cell_.places.resize(nodesOf(shape, degrees));
    const int most = std::max({degrees[0], degrees[1], degrees[2]});
    for (int k = 0; k <= most; ++k)
      for (int j = 0; j <= most; ++j)
        for (int i = 0; i <= most; ++i)
          if (isInside(shape, degrees, i, j, k)) addFrom(i, j, k);
  }
  [[nodiscard]] HigherCell take() { return std::move(cell_); }

 private:
  /// Notes the node's place, and the parts whose smallest place it is.
  void addFrom(int i, int j, int k) {
    const auto at = [&](int x, int y, int z) {
      return nodeAt(shape_, cell_.degrees, i + x, j + y, k + z);
    };
    const auto inside = [&](int x, int y, int z) {
      return isInside(shape_, cell_.degrees, i + x, j + y, k + z);
    };
    assert(at(0, 0, 0) < cell_.places.size());
    cell_.places[at(0, 0, 0)] = {i, j, k};
    if (shape_ == Shape::kHexahedron) {
      if (inside(1, 1, 1))
        add(LinearPart::kHexahedron, {at(0, 0, 0), at(1, 0, 0), at(1, 1, 0), at(0, 1, 0),
                                      at(0, 0, 1), at(1, 0, 1), at(1, 1, 1), at(0, 1, 1)});
    } else if (shape_ == Shape::kWedge) {
      if (inside(1, 0, 1))
        add(LinearPart::kWedge,
            {at(0, 0, 0), at(1, 0, 0), at(0, 1, 0), at(0, 0, 1), at(1, 0, 1), at(0, 1, 1)});
      if (inside(1, 1, 1))
        add(LinearPart::kWedge,
            {at(1, 0, 0), at(1, 1, 0), at(0, 1, 0), at(1, 0, 1), at(1, 1, 1), at(0, 1, 1)});
    } else if (
        shape_ ==
        Shape::
            kPyramid) {  // one upright, one on its apex, and tetrahedra between two of the upright
      if (inside(1, 1, 0))
        add(LinearPart::kPyramid,
            {at(0, 0, 0), at(1, 0, 0), at(1, 1, 0), at(0, 1, 0), at(0, 0, 1)});
      if (inside(1, 1, 1))
        add(LinearPart::kPyramid,
            {at(0, 1, 1), at(1, 1, 1), at(1, 0, 1), at(0, 0, 1), at(1, 1, 0)});
      if (inside(1, 0, 1))
        add(LinearPart::kTetrahedron, {at(1, 0, 0), at(1, 1, 0), at(0, 0, 1), at(1, 0, 1)});
      if (inside(0, 1, 1))
        add(LinearPart::kTetrahedron, {at(0, 1, 0), at(0, 0, 1), at(1, 1, 0), at(0, 1, 1)});
    } else {
      if (inside(1, 0, 0))
        add(LinearPart::kTetrahedron, {at(0, 0, 0), at(1, 0, 0), at(0, 1, 0), at(0, 0, 1)});
      if (inside(1, 1, 0))
        add(LinearPart::kOctahedron,
            {at(1, 0, 0), at(1, 1, 0), at(0, 1, 0), at(0, 0, 1), at(1, 0, 1), at(0, 1, 1)});
      if (inside(1, 1, 1))
        add(LinearPart::kTetrahedron, {at(1, 1, 0), at(0, 1, 1), at(1, 0, 1), at(1, 1, 1)});
    }
  }
  void add(LinearPart::Kind kind, const std::array<std::uint16_t, 8>& nodes) {
    cell_.parts.push_back({kind, nodes});
  }

  Shape shape_;
  HigherCell cell_;
};

}  // namespace

bool isBezierCell(std::uint8_t type) {
  return type >= kBezierTetrahedronCell && type <= kBezierWedgeCell;
}
bool isHigherCell(std::uint8_t type) {
  return type == kLagrangePyramidCell ||
         (type >= kLagrangeTetrahedronCell && type <= kLagrangeWedgeCell) || isBezierCell(type);
}

std::optional<Degrees> degreesOf(std::uint8_t type, std::size_t nodes,
                                 std::span<const double> stated) {
  assert(isHigherCell(type));
  const Shape shape = shapeOfHigher(type);
  if (stated.size() == 3) {
    Degrees degrees{};
    for (std::size_t k = 0; k < 3; ++k) {
      if (!(stated[k] >= 1 && stated[k] <= kMaxDegree)) return std::nullopt;
      degrees[k] = static_cast<int>(stated[k]);
    }
    const bool alike =
        shape == Shape::kHexahedron ||
        (degrees[0] == degrees[1] && (shape == Shape::kWedge || degrees[1] == degrees[2]));
    if (alike && nodesOf(shape, degrees) == nodes) return degrees;
  }
  for (int degree = 1; degree <= kMaxDegree; ++degree) {
    if (nodesOf(shape, {degree, degree, degree}) == nodes) return Degrees{degree, degree, degree};
  }
  return std::nullopt;
}

const HigherCell& higherCell(std::uint8_t type, const Degrees& degrees) {
  assert(isHigherCell(type));
  static std::map<std::pair<Shape, Degrees>, HigherCell> known;
  const Shape shape = shapeOfHigher(type);
  const auto at = known.find({shape, degrees});
  if (at != known.end()) return at->second;
  return known.emplace(std::pair{shape, degrees}, Builder(shape, degrees).take()).first->second;
}

}  // namespace qtet
