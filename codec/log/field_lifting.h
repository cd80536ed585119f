// The encoder's choice of a lifted point field's rules. It moves fused values to what the rules can
// tell (VALUES.md, "Lifted blocks").
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "codec/mesh/mesh.h"
#include "codec/record/lifted_record.h"
#include "codec/record/value_order.h"

namespace qtet {

/// A point field's rules: one for each of PointAncestry::levelStarts().
using LiftingRules = std::vector<LiftingRule>;

/// Which corrections are left out: those below half a unit, small ones, or all. Small ones count
/// less than .8 of a unit, or 1 where the unit is 1. A value may need one to stay in its range.
enum class Skips : std::uint8_t { kHalf, kSmall, kAll };

/// How far a level's fused values may be from those that are wanted.
struct LevelStep {
  /// Corrections count 2^shift; LiftingRule::kNoCorrection: there are none. 0: all values stay.
  int shift = 0;
  Skips skips = Skips::kHalf;
};

/// A field that is lifted. Its values are those of the history's vertices, components each. Where
/// it is an instant's difference to others, `predicted` holds what these give, and is empty if not.
struct LiftedTarget {
  std::uint32_t components = 1;
  bool hasMissing = false;
  std::span<std::int32_t> values;
  std::span<const std::int32_t> predicted{};
};

/// Gives the rule of each level, and moves the fused values, the finest first, to what that tells.
/// A value leaves the range of the field's own, those of fused vertices included, only where a
/// prediction in time does. `steps`: one a level. REQUIRES: a fused value is missing where all of
/// its prey's are, and only there.
[[nodiscard]] LiftingRules liftField(const ValueOrder& order, const LiftedTarget& field,
                                     std::span<const LevelStep> steps);

/// The rules by which all values stay.
[[nodiscard]] LiftingRules exactRules(const ValueOrder& order, const FieldInfo& field,
                                      std::span<const std::int32_t> values);

}  // namespace qtet
