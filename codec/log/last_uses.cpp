#include "codec/log/last_uses.h"

#include <cassert>

namespace qtet {

std::vector<std::vector<std::uint32_t>> lastUses(std::span<const FieldShape> shapes,
                                                 std::span<const std::uint32_t> fields) {
  std::vector<std::vector<std::uint32_t>> out(fields.size());
  std::vector<bool> seen(shapes.size());
  for (std::size_t i = fields.size(); i-- > 0;) {
    const auto use = [&](std::uint32_t field) {
      assert(field < shapes.size());
      if (!seen[field]) out[i].push_back(field);
      seen[field] = true;
    };
    use(fields[i]);
    for (const TimePrediction::Parent& parent : shapes[fields[i]].prediction.all())
      use(parent.field);
  }
  return out;
}

}  // namespace qtet
