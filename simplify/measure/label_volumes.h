// How far a level changes the volume of each label's values.
#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "codec/record/fusion_history.h"

namespace qtet {

/// Values of a label that fill less than this share of the volume do not count: a few cells of them
/// are soon none.
inline constexpr double kSmallLabel = 0.005;

class LabelVolumes {
 public:
  /// REQUIRES: the history at its finest level; it outlives this. `labels` are cell fields of one
  /// component.
  LabelVolumes(const FusionHistory& history, const std::vector<std::uint32_t>& labels);

  /// The largest |V / V0 - 1| of all values, V in the level that the history stands at and V0 in
  /// the finest; 0 without labels.
  [[nodiscard]] double worst() const;

 private:
  using Volumes = std::map<std::int32_t, double>;
  [[nodiscard]] std::vector<Volumes> volumes() const;

  const FusionHistory& history_;
  std::vector<std::uint32_t> labels_;
  std::vector<Volumes> finest_;  // of the values that count
};

}  // namespace qtet
