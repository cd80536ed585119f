#include "codec/log/field_shape.h"

#include <algorithm>
#include <cassert>

namespace qtet {

std::vector<std::uint32_t> withParents(std::span<const FieldShape> fields,
                                       std::span<const std::uint32_t> wanted) {
  // A heap, and no mark for each field: many calls may each want a few of thousands.
  std::vector<std::uint32_t> needed(wanted.begin(), wanted.end());
  std::ranges::make_heap(needed);
  std::vector<std::uint32_t> out;
  while (!needed.empty()) {
    std::ranges::pop_heap(needed);
    const std::uint32_t f = needed.back();
    needed.pop_back();
    if (!out.empty() && out.back() == f) continue;
    out.push_back(f);
    for (const TimePrediction::Parent& parent : fields[f].prediction.all()) {
      assert(parent.field < f);
      needed.push_back(parent.field);
      std::ranges::push_heap(needed);
    }
  }
  std::ranges::reverse(out);
  return out;
}

}  // namespace qtet
