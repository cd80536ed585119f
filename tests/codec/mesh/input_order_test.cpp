// The input's numbering: any permutation of points and cells and any order of vertices comes back;
// patterns cost next to nothing.
#include "codec/mesh/input_order.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>

#include "tests/support/meshes.h"

namespace qtet {
namespace {

/// `cells` in another numbering: point i of the input is `slots[i]`, cell i is `cells[i]`, vertices
/// as `turn` leaves them.
template <class Turn>
InputOrder orderOf(const LatticeMesh& mesh, std::vector<VertexId> slots, std::vector<CellId> cells,
                   const Turn& turn) {
  InputOrder out{std::move(slots), std::move(cells), {}};
  std::vector<VertexId> number(out.points.size());
  for (VertexId i = 0; i < number.size(); ++i) number[out.points[i]] = i;
  for (const CellId c : out.cells) {
    Tetrahedron cell = mesh.tetrahedra[c];
    for (VertexId& v : cell) v = number[v];
    turn(cell);
    out.tetrahedra.push_back(cell);
  }
  return out;
}

std::vector<std::uint32_t> countedUp(std::size_t n) {
  std::vector<std::uint32_t> out(n);
  std::iota(out.begin(), out.end(), 0u);
  return out;
}

struct Sizes {
  std::size_t points, cells;
};

Sizes expectBack(const LatticeMesh& mesh, const InputOrder& order) {
  const DecodedMesh decoded{mesh.points, mesh.tetrahedra};
  const Bytes points = encodePointOrder(decoded, order.points),
              cells = encodeCellOrder(decoded, order);
  const auto back = decodePointOrder(decoded, points);
  EXPECT_TRUE(back) << back.error().text();
  if (!back) return {};
  EXPECT_EQ(*back, order.points);
  InputOrder out{*back, {}, {}};
  const Status status = decodeCellOrder(decoded, cells, out);
  EXPECT_TRUE(status) << status.error().text();
  EXPECT_EQ(out.cells, order.cells);
  EXPECT_EQ(out.tetrahedra, order.tetrahedra);
  return {points.size(), cells.size()};
}

class InputOrders : public ::testing::TestWithParam<std::uint32_t> {};

TEST_P(InputOrders, anyPermutationComesBack) {
  std::mt19937 random(GetParam());
  const LatticeMesh mesh = testing::gridMesh(1 + static_cast<int>(GetParam() % 5), GetParam());
  std::vector<std::uint32_t> points = countedUp(mesh.points.size()),
                             cells = countedUp(mesh.tetrahedra.size());
  std::ranges::shuffle(points, random);
  std::ranges::shuffle(cells, random);
  expectBack(mesh, orderOf(mesh, points, cells,
                           [&](Tetrahedron& cell) { std::ranges::shuffle(cell, random); }));
}

INSTANTIATE_TEST_SUITE_P(Seeds, InputOrders, ::testing::Range(1u, 11u));

TEST(InputOrder, aGridsOwnNumberingTakesFewBits) {
  const LatticeMesh grid = testing::gridMesh(12, 1);
  std::mt19937 random(1);
  // The decoder's numbering is another one: the grid's is to be restored from it.
  std::vector<std::uint32_t> points = countedUp(grid.points.size()),
                             cells = countedUp(grid.tetrahedra.size());
  std::ranges::shuffle(points, random);
  std::ranges::shuffle(cells, random);
  LatticeMesh mesh = grid;
  for (std::size_t i = 0; i < points.size(); ++i) mesh.points[points[i]] = grid.points[i];
  for (std::size_t i = 0; i < cells.size(); ++i) {
    Tetrahedron cell = grid.tetrahedra[i];
    for (VertexId& v : cell) v = points[v];
    std::ranges::rotate(cell.begin(), cell.begin() + 1 + static_cast<std::ptrdiff_t>(random() % 2),
                        cell.begin() + 3);
    mesh.tetrahedra[cells[i]] = cell;
  }
  InputOrder order{points, cells, grid.tetrahedra};
  const Sizes sizes = expectBack(mesh, order);
  EXPECT_LT(8.0 * static_cast<double>(sizes.points), 3.0 * static_cast<double>(points.size()));
  EXPECT_LT(8.0 * static_cast<double>(sizes.cells), 2.0 * static_cast<double>(cells.size()));
}

TEST(InputOrder, damageIsRefusedOrGivesAPermutation) {
  std::mt19937 random(2);
  const LatticeMesh mesh = testing::gridMesh(2, 2);
  const DecodedMesh decoded{mesh.points, mesh.tetrahedra};
  std::vector<std::uint32_t> cells = countedUp(mesh.tetrahedra.size());
  std::ranges::shuffle(cells, random);
  const InputOrder order = orderOf(mesh, countedUp(mesh.points.size()), cells, [](Tetrahedron&) {});
  const Bytes points = encodePointOrder(decoded, order.points),
              cellBytes = encodeCellOrder(decoded, order);
  const auto isPermutation = [](std::vector<std::uint32_t> p) {
    std::ranges::sort(p);
    return p == countedUp(p.size());
  };
  for (std::size_t length = 0; length < points.size(); ++length)
    EXPECT_FALSE(decodePointOrder(decoded, ByteView(points).first(length)));
  for (std::size_t length = 0; length < cellBytes.size(); ++length) {
    InputOrder out{order.points, {}, {}};
    EXPECT_FALSE(decodeCellOrder(decoded, ByteView(cellBytes).first(length), out));
  }
  for (int round = 0; round < 3000; ++round) {
    Bytes a = points, b = cellBytes;
    a[random() % a.size()] ^= static_cast<std::uint8_t>(1 << random() % 8);
    b[random() % b.size()] ^= static_cast<std::uint8_t>(1 << random() % 8);
    if (const auto back = decodePointOrder(decoded, a)) {
      EXPECT_TRUE(isPermutation(*back));
    }
    InputOrder out{order.points, {}, {}};
    if (decodeCellOrder(decoded, b, out)) {
      EXPECT_TRUE(isPermutation(out.cells));
    }
  }
}

}  // namespace
}  // namespace qtet
