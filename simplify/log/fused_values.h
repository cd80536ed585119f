// The values of a log's fused vertices, for fields that come to the log later
// (SERIES.md, "Fields added later").
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "codec/refine/log_history.h"

namespace qtet {

class FusedValues {
 public:
  /// `log` must outlive it.
  explicit FusedValues(const LogHistory& log);

  /// Values of all of the history's vertices from those of the last level's, `components` integers
  /// each. A fused vertex on an edge takes the values of its two prey at its place there. With more
  /// than two prey it takes their mean by the volume that they stand for.
  [[nodiscard]] std::vector<std::int32_t> of(std::vector<std::int32_t> values,
                                             std::uint32_t components) const;

 private:
  const LogHistory& log_;
  std::vector<std::array<double, 4>> shares_;  // of each fusion's prey
};

}  // namespace qtet
