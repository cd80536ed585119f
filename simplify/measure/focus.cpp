#include "simplify/measure/focus.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cstdint>
#include <limits>
#include <vector>

namespace qtet {
namespace {

/// The lattice's span has so many bins.
constexpr int kBinBits = std::numeric_limits<Focus::value_type>::digits;
constexpr std::uint32_t kFocusBins = 1U << kBinBits;
/// The focus holds the cells between these quantiles, out of kQuantiles.
constexpr std::uint64_t kQuantiles = 20, kFrom = 5, kTo = 15;
/// There is one if the cells between these quantiles ...
constexpr std::uint64_t kBulkFrom = 2, kBulkTo = 18;
/// ... take less than 1 / kDwarfed of the mesh's largest extent, which the lattice spans.
constexpr std::uint32_t kDwarfed = 4;
/// The room on each side is 1 / kRoom of the largest extent between the quantiles.
constexpr std::uint32_t kRoom = 4;

/// How many cells' middles lie in each bin along one axis.
class Histogram {
 public:
  void add(std::int64_t bin) {
    assert(bin >= 0 && bin < kFocusBins);
    ++counts_[static_cast<std::size_t>(bin)], ++cells_;
  }

  /// The first bin with which more than `numerator` / kQuantiles of the cells are passed.
  [[nodiscard]] std::uint32_t quantile(std::uint64_t numerator) const {
    assert(numerator < kQuantiles);
    std::uint64_t passed = 0;
    std::uint32_t bin = 0;
    for (; bin + 1 < kFocusBins; ++bin)
      if ((passed += counts_[bin]) * kQuantiles > numerator * cells_) break;
    return bin;
  }

 private:
  std::vector<std::uint64_t> counts_ = std::vector<std::uint64_t>(kFocusBins);
  std::uint64_t cells_ = 0;
};

std::array<Histogram, 3> histogramsOf(const LatticeMesh& mesh) {
  std::array<Histogram, 3> out;
  const int shift = mesh.lattice.bits + 2 - kBinBits;  // four corners add two bits
  for (const auto& [a, b, c, d] : mesh.tetrahedra)
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::int64_t sum = std::int64_t{mesh.points[a][axis]} + mesh.points[b][axis] +
                               mesh.points[c][axis] + mesh.points[d][axis];
      out[axis].add(shift >= 0 ? sum >> shift : sum << -shift);
    }
  return out;
}

}  // namespace

std::optional<Focus> focusOf(const LatticeMesh& mesh) {
  const std::array<Histogram, 3> histograms = histogramsOf(mesh);
  Focus out{};
  std::uint32_t most = 0, extent = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const Histogram& cells = histograms[axis];
    most = std::max(most, cells.quantile(kBulkTo) - cells.quantile(kBulkFrom));
    const std::uint32_t low = cells.quantile(kFrom), high = cells.quantile(kTo);
    assert(low <= high);
    extent = std::max(extent, high - low);
    out[axis] = static_cast<std::uint16_t>(low);
    out[axis + 3] = static_cast<std::uint16_t>(high);
  }
  if (extent == 0 || most * kDwarfed >= kFocusBins) return std::nullopt;
  const std::uint32_t room = extent / kRoom + 1;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    out[axis] = static_cast<std::uint16_t>(out[axis] - std::min<std::uint32_t>(room, out[axis]));
    out[axis + 3] = static_cast<std::uint16_t>(std::min(kFocusBins - 1, out[axis + 3] + room));
  }
  return out;
}

}  // namespace qtet
