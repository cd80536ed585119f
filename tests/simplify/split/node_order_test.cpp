#include "simplify/split/node_order.h"

#include <gtest/gtest.h>
#include <vtkHigherOrderHexahedron.h>
#include <vtkHigherOrderTetra.h>
#include <vtkHigherOrderWedge.h>

namespace qtet {
namespace {

constexpr int kMaxDegree = 6;

TEST(NodeOrder, hexahedraAreNumberedAsVtkNumbersThem) {
  for (int a = 1; a <= kMaxDegree; ++a)
    for (int b = 1; b <= kMaxDegree; ++b)
      for (int c = 1; c <= kMaxDegree; ++c) {
        const std::array order{a, b, c, (a + 1) * (b + 1) * (c + 1)};
        for (int i = 0; i <= a; ++i)
          for (int j = 0; j <= b; ++j)
            for (int k = 0; k <= c; ++k)
              ASSERT_EQ(hexahedronNode({a, b, c}, i, j, k),
                        vtkHigherOrderHexahedron::PointIndexFromIJK(i, j, k, order.data()))
                  << a << b << c << ' ' << i << j << k;
      }
}

TEST(NodeOrder, wedgesAreNumberedAsVtkNumbersThem) {
  constexpr int kSpecialNodes = 21;  // of VTK's wedge of degree 2 with nodes on all middles
  for (int a = 1; a <= kMaxDegree; ++a)
    for (int c = 1; c <= kMaxDegree; ++c) {
      const std::array order{a, a, c, (a + 1) * (a + 2) / 2 * (c + 1)};
      if (order[3] == kSpecialNodes) continue;
      for (int i = 0; i <= a; ++i)
        for (int j = 0; i + j <= a; ++j)
          for (int k = 0; k <= c; ++k)
            ASSERT_EQ(wedgeNode({a, a, c}, i, j, k),
                      vtkHigherOrderWedge::PointIndexFromIJK(i, j, k, order.data()))
                << a << c << ' ' << i << j << k;
    }
}

TEST(NodeOrder, tetrahedraAreNumberedAsVtkNumbersThem) {
  for (int a = 1; a <= 10; ++a)
    for (int i = 0; i <= a; ++i)
      for (int j = 0; i + j <= a; ++j)
        for (int k = 0; i + j + k <= a; ++k) {
          const std::array<vtkIdType, 4> distances{i, j, k, a - i - j - k};
          ASSERT_EQ(tetrahedronNode(a, i, j, k), vtkHigherOrderTetra::Index(distances.data(), a))
              << a << ' ' << i << j << k;
        }
}

}  // namespace
}  // namespace qtet
