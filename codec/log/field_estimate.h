// About how many bits the fields of a record will take. A log's chunks are cut by it, before any
// field is coded.
#pragma once

#include <bit>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <vector>

#include "codec/record/fusion_history.h"
#include "codec/record/value_order.h"
#include "proto/series.h"

namespace qtet {

/// The first instant of a series counts and no other one: a viewer fetches one at a time.
class FieldEstimate {
 public:
  /// `history` must outlive it.
  explicit FieldEstimate(const FusionHistory& history) : history_(history) {
    const std::vector<bool> isLater =
        laterInstants(seriesOf(history.fields), history.fields.size());
    for (std::size_t f = 0; f < history.fields.size(); ++f)
      if (!isLater[f]) (isCellField(history.fields[f]) ? cellFields_ : pointFields_).push_back(f);
  }
  /// For a record that undoes `fusion` and brings the tetrahedra from slot `first` on.
  [[nodiscard]] std::uint64_t bits(const Fusion& fusion, const CellAncestry& cells,
                                   const std::vector<std::uint32_t>& tetrahedra,
                                   CellId first) const {
    std::uint64_t sum = 0;
    for (const std::size_t f : pointFields_) sum += pointBits(f, fusion);
    for (const std::size_t f : cellFields_)
      for (CellId t = first; t < tetrahedra.size(); ++t) sum += cellBits(f, cells, tetrahedra, t);
    return sum;
  }

 private:
  static std::uint64_t bitsOf(std::int64_t value) {
    return static_cast<std::uint64_t>(std::bit_width(static_cast<std::uint64_t>(std::abs(value))));
  }
  [[nodiscard]] std::uint64_t pointBits(std::size_t f, const Fusion& fusion) const {
    const std::vector<std::int32_t>& values = history_.values[f];
    const std::size_t n = history_.fields[f].components;
    std::uint64_t sum = 0;
    for (std::size_t i = 1; i < fusion.k; ++i)
      for (std::size_t c = 0; c < n; ++c)
        sum += 1 + bitsOf(std::int64_t{values[fusion.prey[i] * n + c]} -
                          values[fusion.prey[0] * n + c]);
    return sum;
  }
  [[nodiscard]] std::uint64_t cellBits(std::size_t f, const CellAncestry& cells,
                                       const std::vector<std::uint32_t>& tetrahedra,
                                       CellId cell) const {
    const std::size_t n = history_.fields[f].components;
    std::uint64_t sum = 0;
    for (std::size_t c = 0; c < n; ++c) {
      const auto at = [&](CellId u) { return history_.values[f][tetrahedra[u] * n + c]; };
      sum += bitsOf(at(cell) - cells.predict(cell, at));
    }
    return sum;
  }

  const FusionHistory& history_;
  std::vector<std::size_t> pointFields_, cellFields_;
};

}  // namespace qtet
