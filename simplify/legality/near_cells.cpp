#include "simplify/legality/near_cells.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <tuple>

#include "simplify/legality/lattice_rounding.h"
#include "simplify/legality/touched_cells.h"

namespace qtet {
namespace {

/// Half of a unit cube's diagonal, rounded up.
constexpr double kHalfDiagonal = 0.8660255;
/// A cube's length over the tolerance: below 0.57 all that the surface passes are near.
constexpr double kLength = 0.4;
/// Cubes along an axis, at most, if lengths are not rounded down. The directory has at most 256^3
/// blocks of four bytes.
constexpr std::int32_t kMaxAlong = 1024;
/// A triangle whose box touches more blocks is looked for from the whole grid down.
constexpr double kManyBlocks = 64;

NearCells::Cell firstOf(const NearCells::Cell& block, std::int32_t length) {
  return {block[0] * length, block[1] * length, block[2] * length};
}

double squaredToBox(const Vector3& p, const Vector3& low, const Vector3& high) {
  double squared = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const double apart = std::max({low[k] - p[k], p[k] - high[k], 0.0});
    squared += apart * apart;
  }
  return squared;
}

}  // namespace

NearCells::NearCells(const TriangleTree& tree, std::span<const float> tolerances, double most,
                     const IsInside& isInside) {
  assert(tolerances.size() == tree.builtOver());
  double extent = 1;
  for (std::uint32_t t = 0; t < tolerances.size(); ++t)
    for (const Vector3& c : tree.corners(t)) extent = std::max({extent, c[0], c[1], c[2]});
  if (!(kLength * most >= 1) || kMaxAlong * kLength * most <= extent + most) return;
  length_ = std::floor(std::min(kLength * most, extent));
  const auto cells = static_cast<std::int32_t>((extent + most) / length_) + 1;
  assert(length_ >= 1 && cells > 0);
  blockCounts_.fill((cells >> kBlockBits) + 1);
  directory_.assign(placeOf({0, 0, blockCounts_[2]}), kUnknown);
  rootBits_ = std::bit_width(static_cast<std::uint32_t>(blockCounts_[0] * kBlockLength - 1));
  const double half = kHalfDiagonal * length_ + kDistanceRounding;
  for (std::uint32_t t = 0; t < tolerances.size(); ++t) {
    Spread of{tree.corners(t), {}, {}, {}, tolerances[t] - half, half};
    of.middle = 1 / 3.0 * (of.triangle[0] + of.triangle[1] + of.triangle[2]);
    for (std::size_t k = 0; k < 3; ++k)
      std::tie(of.low[k], of.high[k]) =
          std::minmax({of.triangle[0][k], of.triangle[1][k], of.triangle[2][k]});
    spread(of);
  }
  findInside(isInside);
  passed_ = {};
}

std::size_t NearCells::placeOf(const Cell& block) const {
  assert(block[0] >= 0 && block[1] >= 0 && block[2] >= 0);
  return (static_cast<std::size_t>(block[2]) * blockCounts_[1] + block[1]) * blockCounts_[0] +
         block[0];
}

bool NearCells::isBlock(const Cell& block) const {
  bool is = true;
  for (std::size_t k = 0; k < 3; ++k) is &= block[k] >= 0 && block[k] < blockCounts_[k];
  return is;
}

Vector3 NearCells::middleOf(const Cell& low, double cells) const {
  Vector3 out{};
  for (std::size_t k = 0; k < 3; ++k) out[k] = length_ * (low[k] + 0.5 * cells);
  return out;
}

std::uint32_t NearCells::blockOf(const Cell& cell) {
  const Cell block{cell[0] >> kBlockBits, cell[1] >> kBlockBits, cell[2] >> kBlockBits};
  assert(isBlock(block));
  std::uint32_t& own = directory_[placeOf(block)];
  if (own == kUnknown) {
    own = static_cast<std::uint32_t>(blocks_.size()) + kFirstBlock;
    blocks_.push_back({}), passed_.push_back({});
  }
  return own - kFirstBlock;
}

// From the blocks round the triangle, or from all where these are many.
void NearCells::spread(const Spread& of) {
  const double farthest = std::max(of.near, of.passed);
  Cell low{}, high{};
  double blocks = 1;
  for (std::size_t k = 0; k < 3; ++k) {
    const double block = kBlockLength * length_;
    low[k] = static_cast<std::int32_t>(std::max(0.0, (of.low[k] - farthest) / block));
    high[k] =
        std::min(blockCounts_[k] - 1, static_cast<std::int32_t>((of.high[k] + farthest) / block));
    blocks *= high[k] - low[k] + 1;
  }
  if (blocks > kManyBlocks) return spread(of, {{0, 0, 0}, rootBits_});
  for (std::int32_t z = low[2]; z <= high[2]; ++z)
    for (std::int32_t y = low[1]; y <= high[1]; ++y)
      for (std::int32_t x = low[0]; x <= high[0]; ++x)
        spread(of, {firstOf({x, y, z}, kBlockLength), kBlockBits});
}

// All cubes of a node within a block are near already.
bool NearCells::isAllNear(const Node& node) const {
  assert(node.bits >= 0 && node.bits <= kBlockBits);
  const std::uint32_t own = directory_[placeOf(
      {node.low[0] >> kBlockBits, node.low[1] >> kBlockBits, node.low[2] >> kBlockBits})];
  if (own < kFirstBlock) return false;
  const Block& near = blocks_[own - kFirstBlock];
  const std::uint64_t row = (std::uint64_t{1} << (1 << node.bits)) - 1;
  std::uint64_t square = row;
  for (int i = 0; i < node.bits; ++i) square |= square << (8 << i);
  square <<= (node.low[1] & 7) * 8 + (node.low[0] & 7);
  std::uint64_t all = square;
  for (std::int32_t z = 0; z < 1 << node.bits; ++z) all &= near[(node.low[2] & 7) + z];
  return all == square;
}

// A cube's points lie within half of its diagonal from its middle.
void NearCells::spread(const Spread& of, const Node& node) {
  const double cells = static_cast<double>(1 << node.bits);
  const double inner = kHalfDiagonal * length_ * (cells - 1);  // to the middles of its cubes
  const double farthest = std::max(of.near, of.passed) + inner;
  const Vector3 middle = middleOf(node.low, cells);
  if (squaredToBox(middle, of.low, of.high) > farthest * farthest) return;
  if (node.bits <= kBlockBits && isAllNear(node)) return;
  const Vector3 apart = middle - of.middle;
  const bool isSurelyNear =
      node.bits == 0 && of.near > of.passed && dot(apart, apart) <= of.near * of.near;
  const double squared = isSurelyNear ? 0 : nearestOnTriangle(middle, of.triangle).squared;
  if (squared > farthest * farthest) return;
  if (node.bits == 0) {
    const std::uint32_t block = blockOf(node.low);
    const auto bit = std::uint64_t{1} << ((node.low[1] & 7) * 8 + (node.low[0] & 7));
    if (of.near >= 0 && squared <= of.near * of.near) blocks_[block][node.low[2] & 7] |= bit;
    if (squared <= of.passed * of.passed) passed_[block][node.low[2] & 7] |= bit;
    return;
  }
  const std::int32_t half = 1 << (node.bits - 1);
  for (std::int32_t part = 0; part < 8; ++part) {
    const Cell low{node.low[0] + (part & 1) * half, node.low[1] + (part >> 1 & 1) * half,
                   node.low[2] + (part >> 2) * half};
    if (isBlock({low[0] >> kBlockBits, low[1] >> kBlockBits, low[2] >> kBlockBits}))
      spread(of, {low, node.bits - 1});
  }
}

bool NearCells::isNear(const Cell& cell) const {
  const Cell block{cell[0] >> kBlockBits, cell[1] >> kBlockBits, cell[2] >> kBlockBits};
  if (!isBlock(block)) return false;
  const std::uint32_t own = directory_[placeOf(block)];
  if (own < kFirstBlock) return own == kInside;
  return (blocks_[own - kFirstBlock][cell[2] & 7] >> ((cell[1] & 7) * 8 + (cell[0] & 7)) & 1) != 0;
}

bool NearCells::areNear(const Cell& low, const Cell& high) const {
  assert(low[0] <= high[0] && low[1] <= high[1] && low[2] <= high[2]);
  // the bits from `from` to `to`
  const auto run = [](int from, int to) { return (2u << to) - (1u << from); };
  Cell block{};
  for (block[2] = low[2] >> kBlockBits; block[2] <= high[2] >> kBlockBits; ++block[2])
    for (block[1] = low[1] >> kBlockBits; block[1] <= high[1] >> kBlockBits; ++block[1])
      for (block[0] = low[0] >> kBlockBits; block[0] <= high[0] >> kBlockBits; ++block[0]) {
        if (!isBlock(block)) return false;
        const std::uint32_t own = directory_[placeOf(block)];
        if (own == kInside) continue;
        if (own == kUnknown) return false;
        Cell first{}, last{};
        for (std::size_t k = 0; k < 3; ++k) {
          const std::int32_t origin = block[k] * kBlockLength;
          first[k] = std::max(low[k] - origin, 0);
          last[k] = std::min(high[k] - origin, kBlockLength - 1);
        }
        assert(first[0] <= last[0] && first[1] <= last[1] && last[0] < kBlockLength);
        std::uint64_t square = 0;
        for (std::int32_t y = first[1]; y <= last[1]; ++y)
          square |= std::uint64_t{run(first[0], last[0])} << 8 * y;
        for (std::int32_t z = first[2]; z <= last[2]; ++z)
          if ((blocks_[own - kFirstBlock][z] & square) != square) return false;
      }
  return true;
}

// No surface passes between two cubes side by side which it does not pass.
void NearCells::findInside(const IsInside& isInside) {
  std::vector<std::uint8_t> isSeen(directory_.size());
  Cell block{};
  for (block[2] = 0; block[2] < blockCounts_[2]; ++block[2])
    for (block[1] = 0; block[1] < blockCounts_[1]; ++block[1])
      for (block[0] = 0; block[0] < blockCounts_[0]; ++block[0]) {
        if (directory_[placeOf(block)] >= kFirstBlock)
          fillBlock(block, isInside);
        else if (isSeen[placeOf(block)] == 0)
          fillEmpty(block, isInside, isSeen);
      }
}

// The cubes of a block that are neither near nor passed, in parts that hang together. One place
// decides for each.
void NearCells::fillBlock(const Cell& block, const IsInside& isInside) {
  const std::uint32_t number = directory_[placeOf(block)] - kFirstBlock;
  assert(number < blocks_.size() && passed_.size() == blocks_.size());
  Block& near = blocks_[number];
  constexpr std::uint64_t kNotFirst = 0xfefefefefefefefe, kNotLast = 0x7f7f7f7f7f7f7f7f;
  Block open, inside{};
  for (std::size_t z = 0; z < 8; ++z) open[z] = ~(near[z] | passed_[number][z]);
  for (std::size_t z = 0; z < 8; ++z)
    while (open[z] != 0) {
      const int first = std::countr_zero(open[z]);
      Block part{};
      part[z] = std::uint64_t{1} << first;
      for (bool grows = true; grows;) {
        grows = false;
        for (std::size_t k = 0; k < 8; ++k) {
          const std::uint64_t old = part[k];
          std::uint64_t more = old | (old << 1 & kNotFirst) | (old >> 1 & kNotLast) | old << 8 |
                               old >> 8 | (k > 0 ? part[k - 1] : 0) | (k < 7 ? part[k + 1] : 0);
          part[k] = more & open[k];
          grows |= part[k] != old;
        }
      }
      const Cell low = firstOf(block, kBlockLength);
      const bool isIn = isInside(
          middleOf({low[0] + first % 8, low[1] + first / 8, low[2] + static_cast<int>(z)}, 1));
      for (std::size_t k = 0; k < 8; ++k) {
        open[k] &= ~part[k];
        if (isIn) inside[k] |= part[k];
      }
    }
  for (std::size_t z = 0; z < 8; ++z) near[z] |= inside[z];
}

// The same of whole blocks that have no other cubes.
void NearCells::fillEmpty(const Cell& first, const IsInside& isInside,
                          std::vector<std::uint8_t>& isSeen) {
  assert(directory_[placeOf(first)] == kUnknown);
  const bool isIn = isInside(middleOf(firstOf(first, kBlockLength), kBlockLength));
  std::vector<Cell> waiting{first};
  isSeen[placeOf(first)] = 1;
  while (!waiting.empty()) {
    const Cell block = waiting.back();
    waiting.pop_back();
    if (isIn) directory_[placeOf(block)] = kInside;
    for (std::size_t k = 0; k < 6; ++k) {
      Cell beside = block;
      beside[k / 2] += k % 2 == 0 ? 1 : -1;
      if (!isBlock(beside) || isSeen[placeOf(beside)] != 0 ||
          directory_[placeOf(beside)] != kUnknown)
        continue;
      isSeen[placeOf(beside)] = 1;
      waiting.push_back(beside);
    }
  }
}

// The last corner is where the prey goes: if anything lies too far outside, it often does. Most
// tetrahedra have nothing but near cubes in their whole box.
bool NearCells::holds(const Corners& tetrahedron) const {
  assert(isKnown());
  Corners at = tetrahedron;
  for (Vector3& c : at) c = 1 / length_ * c;
  Cell last{}, low{}, high{};
  for (std::size_t k = 0; k < 3; ++k) {
    last[k] = static_cast<std::int32_t>(at[3][k]);
    const auto [least, largest] = std::minmax({at[0][k], at[1][k], at[2][k], at[3][k]});
    low[k] = static_cast<std::int32_t>(std::max(least - kTouchSlack, 0.0));
    high[k] = static_cast<std::int32_t>(largest + kTouchSlack);
  }
  if (!isNear(last)) return false;
  if (areNear(low, high)) return true;
  bool isHeld = true;
  eachTouchedCell(at, [&](const Cell& cell) { return isHeld = isNear(cell); });
  return isHeld;
}

}  // namespace qtet
