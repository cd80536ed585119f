#include "simplify/log/fused_values.h"

#include "codec/log/field_lifting.h"

namespace qtet {

std::vector<std::int32_t> fusedValues(const LogHistory& log, std::vector<std::int32_t> values,
                                      std::uint32_t components) {
  values.resize(log.history.points.size() * components);
  static_cast<void>(followPrey(log.order, {components, false, values}));
  return values;
}

}  // namespace qtet
