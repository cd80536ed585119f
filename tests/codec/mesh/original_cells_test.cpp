// The file's cells: any numbers come back; runs of tetrahedra of one cell cost next to nothing.
#include "codec/mesh/original_cells.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace qtet {
namespace {

std::size_t expectBack(const std::vector<std::uint32_t>& ids) {
  const Bytes bytes = encodeOriginalCells(ids);
  const auto back = decodeOriginalCells(bytes, ids.size());
  EXPECT_TRUE(back && *back == ids);
  return bytes.size();
}

std::vector<std::uint32_t> runs(std::uint32_t cells, std::uint32_t length, std::uint32_t step) {
  std::vector<std::uint32_t> out;
  for (std::uint32_t cell = 0; cell < cells; ++cell) out.resize(out.size() + length, cell * step);
  return out;
}

TEST(OriginalCells, anyNumbersComeBack) {
  expectBack({});
  expectBack({0});
  expectBack({kOriginalCellEnd - 1, 0, kOriginalCellEnd - 1, 1, 1, 0, 2});
  std::mt19937 random(3);
  for (int round = 0; round < 20; ++round) {
    std::vector<std::uint32_t> ids(random() % 300);
    for (std::uint32_t& id : ids)
      id = static_cast<std::uint32_t>(random()) % (round % 2 == 0 ? 5 : kOriginalCellEnd);
    expectBack(ids);
  }
}

TEST(OriginalCells, runsCostNextToNothing) {
  // 6,000 hexahedra, cells of 125 tetrahedra, every third cell of the file
  EXPECT_LE(expectBack(runs(6000, 6, 1)), 120u);
  EXPECT_LE(expectBack(runs(300, 125, 1)), 600u);
  EXPECT_LE(expectBack(runs(6000, 6, 3)), 400u);
}

TEST(OriginalCells, everyCutAndEveryOtherLengthIsRefused) {
  const std::vector<std::uint32_t> ids = runs(40, 3, 7);
  const Bytes good = encodeOriginalCells(ids);
  for (std::size_t n = 0; n < good.size(); ++n)
    EXPECT_EQ(decodeOriginalCells(ByteView(good).first(n), ids.size()).error().code,
              ErrorCode::kBadValue)
        << n;
  Bytes longer = good;
  longer.push_back(1);
  EXPECT_EQ(decodeOriginalCells(longer, ids.size()).error().code, ErrorCode::kBadValue);
}

TEST(OriginalCells, aNumberBeyondTheEndIsRefused) {
  const Bytes bytes = encodeOriginalCells(std::vector{kOriginalCellEnd});
  EXPECT_EQ(decodeOriginalCells(bytes, 1).error().code, ErrorCode::kBadValue);
}

TEST(OriginalCells, flippedBitsGiveNumbersOrAnError) {
  const std::vector<std::uint32_t> ids = runs(40, 3, 7);
  const Bytes good = encodeOriginalCells(ids);
  for (std::size_t bit = 0; bit < 8 * good.size(); ++bit) {
    Bytes bad = good;
    bad[bit / 8] ^= static_cast<std::uint8_t>(1u << bit % 8);
    const auto read = decodeOriginalCells(bad, ids.size());
    if (!read) {
      EXPECT_EQ(read.error().code, ErrorCode::kBadValue) << bit;
    } else {
      EXPECT_TRUE(std::ranges::all_of(*read, [](auto id) { return id < kOriginalCellEnd; }));
    }
  }
}

}  // namespace
}  // namespace qtet
