#include "simplify/gmsh_elements.h"

#include <array>

#include "simplify/cell_mesh.h"

namespace qtet {
namespace {

// Gmsh's edge nodes: https://gmsh.info/doc/texinfo/gmsh.html#Node-ordering; VTK's: cell_shapes.cpp.
constexpr std::uint8_t kTetrahedron10[] = {0, 1, 2, 3, 4, 5, 6, 7, 9, 8};
constexpr std::uint8_t kHexahedron20[] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 11, 13, 9, 16, 18, 19, 17, 10, 12, 14, 15};
constexpr std::uint8_t kHexahedron27[] = {0,  1,  2,  3,  4,  5,  6,  7,  8,  11, 13, 9,  16, 18,
                                          19, 17, 10, 12, 14, 15, 22, 23, 21, 24, 20, 25, 26};
constexpr std::uint8_t kPrism15[] = {0, 1, 2, 3, 4, 5, 6, 9, 7, 12, 14, 13, 8, 10, 11};
constexpr std::uint8_t kPrism18[] = {0, 1, 2, 3, 4, 5, 6, 9, 7, 12, 14, 13, 8, 10, 11, 15, 17, 16};
constexpr std::uint8_t kPyramid13[] = {0, 1, 2, 3, 4, 5, 8, 10, 6, 7, 9, 11, 12};
constexpr std::uint8_t kPyramid14[] = {0, 1, 2, 3, 4, 5, 8, 10, 6, 7, 9, 11, 12, 13};

}  // namespace

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
    case 29: return {20, kLagrangeTetrahedronCell};
    case 30: return {35, kLagrangeTetrahedronCell};
    case 31: return {56, kLagrangeTetrahedronCell};
    case 36: return {16};
    case 37: return {25};
    case 38: return {36};
    case 90: return {40, kLagrangeWedgeCell};
    case 91: return {75, kLagrangeWedgeCell};
    case 92: return {64, kLagrangeHexahedronCell};
    case 93: return {125, kLagrangeHexahedronCell};
    default: return {};
  }
}

}  // namespace qtet
