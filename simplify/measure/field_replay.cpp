#include "simplify/measure/field_replay.h"

#include <cassert>

namespace qtet {

std::vector<FieldError> FieldReplay::errors(const FusionHistory& history, std::size_t field,
                                            std::size_t unmeasured) const {
  std::vector<FieldError> out(levels.size());
  assert(field >= unmeasured && field - unmeasured < ranges.size());
  assert(roundings.size() == ranges.size() && !isCellField(history.fields[field]));
  const double range = ranges[field - unmeasured];
  if (levels.empty() || !(range > 0)) return out;
  const std::vector<std::int32_t>& values = history.values[field];
  const std::size_t components = history.fields[field].components;
  const std::size_t places = levels.front().moved.size();
  assert(uniform <= places);
  std::vector<double> truth(places * components), squared(places);
  std::vector<std::uint8_t> isOriginal(places);
  for (std::size_t level = 0; level < levels.size(); ++level) {
    for (const ReplayedPlace& place : levels[level].moved) {
      assert(place.place < places);
      double sum = 0;
      for (std::size_t c = 0; c < components; ++c) {
        double& wanted = truth[place.place * components + c];
        const double value = valueIn(place.corners, place.weights, values, components, c);
        if (level == 0) wanted = value;
        sum += (value - wanted) * (value - wanted);
      }
      squared[place.place] = sum / (range * range);
      isOriginal[place.place] = place.isOriginal ? 1 : 0;
    }
    out[level] = errorOf(squared, uniform, roundings[field - unmeasured],
                         [&](std::size_t i) { return isOriginal[i] != 0; });
  }
  return out;
}

}  // namespace qtet
