#include "simplify/log/fused_values.h"

#include <algorithm>
#include <array>
#include <cstddef>

#include "codec/record/lifted_values.h"

namespace qtet {

std::vector<std::int32_t> fusedValues(const LogHistory& log, std::vector<std::int32_t> values,
                                      std::uint32_t components) {
  const ValueOrder& order = log.order;
  const std::size_t n = components;
  std::vector<std::int32_t> now = values;  // by slot
  const auto [least, most] = std::ranges::minmax(values);
  constexpr LiftingRule kRule{LiftingRule::kNoCorrection, LiftingRule::kUsualCurve};
  values.resize(log.history.points.size() * n);
  for (std::size_t b = order.points.births().size(); b-- > 0;) {
    const Birth& birth = order.points.births()[b];
    const LiftedRecord record(birth, order.points.slopesAt(birth));
    for (std::size_t c = 0; c < n; ++c) {
      std::array<std::int64_t, LiftedRecord::kMaxPrey> prey{};
      for (std::size_t i = 0; i < birth.k; ++i)
        prey[i] = now[(i == 0 ? birth.slot : birth.firstNew + i - 1) * n + c];
      const std::int64_t fused =
          record.follows(kRule, prey, [&](VertexId v) -> std::int64_t { return now[v * n + c]; });
      now[birth.slot * n + c] = values[order.fused[b] * n + c] =
          static_cast<std::int32_t>(std::clamp<std::int64_t>(fused, least, most));
    }
  }
  return values;
}

}  // namespace qtet
