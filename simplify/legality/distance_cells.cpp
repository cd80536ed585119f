#include "simplify/legality/distance_cells.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <utility>

namespace qtet {
namespace {

/// Slots at first, and at most: 24 bytes each, half of them taken. A boundary has some 100,000
/// cubes of half a percent of its extent, and a coarse one asks for larger ones.
constexpr std::size_t kFirstSlots = 1 << 12, kMaxSlots = 1 << 22;

// The finaliser of SplitMix64 (Steele, Lea and Flood 2014) over the numbers in a row.
std::size_t hashOf(const LatticeCube& cube) {
  std::uint64_t h = cube.bits;
  for (const std::uint32_t n : cube.number) {
    h = (h + n) * 0x9e3779b97f4a7c15u;
    h ^= h >> 29;
  }
  h *= 0xbf58476d1ce4e5b9u;
  return static_cast<std::size_t>(h ^ h >> 32);
}

}  // namespace

LatticeCube LatticeCube::at(const Vector3& p, int bits) {
  assert(std::ranges::all_of(p, [](double x) { return x >= 0 && x < 0x1p30; }));
  assert(bits >= 0 && bits < 32);
  LatticeCube out{static_cast<std::uint8_t>(bits), {}};
  for (std::size_t k = 0; k < 3; ++k) out.number[k] = static_cast<std::uint32_t>(p[k]) >> bits;
  return out;
}

Vector3 LatticeCube::middle() const {
  Vector3 out{};
  for (std::size_t k = 0; k < 3; ++k) out[k] = (static_cast<double>(number[k]) + 0.5) * length();
  return out;
}

DistanceCells::Slot& DistanceCells::slotOf(const LatticeCube& cube) {
  if (2 * taken_ >= slots_.size()) grow();
  assert(2 * taken_ < slots_.size());
  Slot& slot = find(cube);
  taken_ += !slot.isTaken;
  return slot;
}

DistanceCells::Slot& DistanceCells::find(const LatticeCube& cube) {
  assert(taken_ < slots_.size() && std::has_single_bit(slots_.size()));
  for (std::size_t i = hashOf(cube) & (slots_.size() - 1);; i = (i + 1) & (slots_.size() - 1))
    if (!slots_[i].isTaken || slots_[i].cube == cube) return slots_[i];
}

void DistanceCells::grow() {
  assert(slots_.size() <= kMaxSlots && 2 * taken_ >= slots_.size());
  const bool isFull = slots_.size() == kMaxSlots;
  std::vector<Slot> old(isFull ? kMaxSlots : std::max(kFirstSlots, 2 * slots_.size()));
  std::swap(old, slots_);
  if (isFull) old.clear(), taken_ = 0;
  for (const Slot& slot : old)
    if (slot.isTaken) find(slot.cube) = slot;
}

}  // namespace qtet
