#include "codec/log/field_shape.h"

#include <algorithm>

namespace qtet {

std::vector<std::uint32_t> withParents(std::span<const FieldShape> fields,
                                       std::span<const std::uint32_t> wanted) {
  std::vector<bool> needed(fields.size());
  for (const std::uint32_t f : wanted) needed[f] = true;
  std::vector<std::uint32_t> out;
  for (auto f = static_cast<std::uint32_t>(fields.size()); f-- > 0;) {
    if (!needed[f]) continue;
    out.push_back(f);
    for (const TimePrediction::Parent& parent : fields[f].prediction.all())
      needed[parent.field] = true;
  }
  std::ranges::reverse(out);
  return out;
}

}  // namespace qtet
