#include "simplify/split/cell_shapes.h"

#include "simplify/split/cell_mesh.h"

namespace qtet {
namespace {

using Edge = std::array<std::uint8_t, 2>;

constexpr ShapeFace kTetrahedronFaces[] = {
    {3, {0, 1, 3}}, {3, {1, 2, 3}}, {3, {2, 0, 3}}, {3, {0, 2, 1}}};
constexpr ShapeFace kHexahedronFaces[] = {{4, {0, 4, 7, 3}}, {4, {1, 2, 6, 5}}, {4, {0, 1, 5, 4}},
                                          {4, {3, 7, 6, 2}}, {4, {0, 3, 2, 1}}, {4, {4, 5, 6, 7}}};
constexpr ShapeFace kVoxelFaces[] = {{4, {0, 4, 6, 2}}, {4, {1, 3, 7, 5}}, {4, {0, 1, 5, 4}},
                                     {4, {2, 6, 7, 3}}, {4, {0, 2, 3, 1}}, {4, {4, 5, 7, 6}}};
constexpr ShapeFace kWedgeFaces[] = {
    {3, {0, 1, 2}}, {3, {3, 5, 4}}, {4, {0, 3, 4, 1}}, {4, {1, 4, 5, 2}}, {4, {2, 5, 3, 0}}};
constexpr ShapeFace kPyramidFaces[] = {
    {4, {0, 3, 2, 1}}, {3, {0, 1, 4}}, {3, {1, 2, 4}}, {3, {2, 3, 4}}, {3, {3, 0, 4}}};
constexpr ShapeFace kPentagonalPrismFaces[] = {
    {5, {0, 4, 3, 2, 1}}, {5, {5, 6, 7, 8, 9}}, {4, {0, 1, 6, 5}}, {4, {1, 2, 7, 6}},
    {4, {2, 3, 8, 7}},    {4, {3, 4, 9, 8}},    {4, {4, 0, 5, 9}}};
constexpr ShapeFace kHexagonalPrismFaces[] = {
    {6, {0, 5, 4, 3, 2, 1}}, {6, {6, 7, 8, 9, 10, 11}}, {4, {0, 1, 7, 6}},   {4, {1, 2, 8, 7}},
    {4, {2, 3, 9, 8}},       {4, {3, 4, 10, 9}},        {4, {4, 5, 11, 10}}, {4, {5, 0, 6, 11}}};

constexpr Edge kTetrahedronEdges[] = {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}};
constexpr Edge kHexahedronEdges[] = {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {4, 5}, {5, 6},
                                     {6, 7}, {7, 4}, {0, 4}, {1, 5}, {2, 6}, {3, 7}};
constexpr Edge kWedgeEdges[] = {{0, 1}, {1, 2}, {2, 0}, {3, 4}, {4, 5},
                                {5, 3}, {0, 3}, {1, 4}, {2, 5}};
constexpr Edge kPyramidEdges[] = {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {0, 4}, {1, 4}, {2, 4}, {3, 4}};

constexpr std::uint8_t kNo = kNoNode;

}  // namespace

CellShape shapeOf(std::uint8_t type) {
  switch (type) {
    case kTetrahedronCell:
    case kQuadraticTetrahedronCell:
    case kLagrangeTetrahedronCell:
    case kBezierTetrahedronCell: return {4, kTetrahedronFaces, kTetrahedronEdges};
    case kVoxelCell: return {8, kVoxelFaces, {}};
    case kHexahedronCell:
    case kQuadraticHexahedronCell:
    case kTriquadraticHexahedronCell:
    case kBiquadraticQuadraticHexahedronCell:
    case kLagrangeHexahedronCell:
    case kBezierHexahedronCell: return {8, kHexahedronFaces, kHexahedronEdges};
    case kWedgeCell:
    case kQuadraticWedgeCell:
    case kQuadraticLinearWedgeCell:
    case kBiquadraticQuadraticWedgeCell:
    case kLagrangeWedgeCell:
    case kBezierWedgeCell: return {6, kWedgeFaces, kWedgeEdges};
    case kPyramidCell:
    case kQuadraticPyramidCell:
    case kBiquadraticPyramidCell:
    case kTriquadraticPyramidCell:
    case kLagrangePyramidCell: return {5, kPyramidFaces, kPyramidEdges};
    case kPentagonalPrismCell: return {10, kPentagonalPrismFaces, {}};
    case kHexagonalPrismCell: return {12, kHexagonalPrismFaces, {}};
    default: return {};
  }
}

CurvedNodes curvedNodesOf(std::uint8_t type) {
  switch (type) {
    case kQuadraticTetrahedronCell: return {true, kTetrahedronEdges};
    case kQuadraticHexahedronCell: return {true, kHexahedronEdges};
    case kTriquadraticHexahedronCell: return {true, kHexahedronEdges, {20, 21, 22, 23, 24, 25}, 26};
    case kBiquadraticQuadraticHexahedronCell:
      return {true, kHexahedronEdges, {23, 21, 20, 22, kNo, kNo}};
    case kQuadraticWedgeCell: return {true, kWedgeEdges};
    case kBiquadraticQuadraticWedgeCell: return {true, kWedgeEdges, {kNo, kNo, 15, 16, 17, kNo}};
    case kQuadraticLinearWedgeCell: return {true, std::span(kWedgeEdges).first(6)};
    case kQuadraticPyramidCell: return {true, kPyramidEdges};
    case kBiquadraticPyramidCell: return {true, kPyramidEdges, {13, kNo, kNo, kNo, kNo, kNo}};
    case kTriquadraticPyramidCell: return {true, kPyramidEdges, {13, 14, 15, 16, 17, kNo}, 18};
    default: return {};
  }
}

}  // namespace qtet
