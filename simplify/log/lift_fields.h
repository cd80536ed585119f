// How exactly the coarse levels of a log keep their fields (ALGORITHM.md, "Coarse values").
#pragma once

#include <cstdint>
#include <span>
#include <stop_token>
#include <vector>

#include "codec/log/field_lifting.h"
#include "codec/record/fusion_history.h"
#include "codec/record/value_order.h"
#include "proto/error.h"
#include "proto/level_error.h"
#include "simplify/measure/field_replay.h"

namespace qtet {

/// How much a field's known rms may grow in levels of at most a quarter of the cells. The second
/// one is for those up to half, the third for finer ones. An rms below kSmallSteps of the field's
/// steps is mostly that of rounding, and may grow more.
inline constexpr double kMostGrowth = 1.03, kMostHalfGrowth = 1.05, kMostFineGrowth = 1.12,
                        kMostSmallGrowth = 1.15, kSmallSteps = 0.3;

struct LiftOptions {
  /// The fields before it stay as they are. The lists below begin with it.
  std::size_t firstField = 0;
  /// By field, which of the original's values are missing; none in an empty list.
  std::span<const std::vector<std::uint8_t>> missing{};
  /// Where the levels were measured.
  const FieldReplay* replay = nullptr;
  /// How corrections count without it, as LevelStep::shift.
  int unmeasuredShift = 0;
  std::vector<std::size_t> exact{};  ///< fields whose fused values stay too
  std::stop_token stop{};            ///< asked at every field
};

/// Moves the fused values of point fields of floats, so that their corrections take few bits. A
/// correction counts about the known error of its level, more in fine levels, and the finest have
/// none. It counts less where a field's rms grows by more than kMostGrowth. Instants that are
/// predicted from others follow the moved ones. Takes and leaves a number everywhere. `errors`: the
/// known errors of the values that come, then of those that go. Gives each field's rules, none to a
/// cell field. Errors: cancelled. REQUIRES: fields in the order of decoding.
[[nodiscard]] Result<std::vector<LiftingRules>> liftFields(FusionHistory& history,
                                                           const ValueOrder& order,
                                                           LevelErrors& errors,
                                                           const LiftOptions& options);

}  // namespace qtet
