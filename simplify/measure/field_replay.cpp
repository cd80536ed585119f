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
  const bool isKnown = !truth.empty();
  std::vector<double> wanted =
      isKnown ? truth[field - unmeasured] : std::vector<double>(places * components);
  std::vector<double> squared(places);
  std::vector<std::uint8_t> isOriginal(places);
  for (std::size_t level = 0; level < levels.size(); ++level) {
    for (const ReplayedPlace& place : levels[level].moved) {
      assert(place.place < places);
      double sum = 0;
      for (std::size_t c = 0; c < components; ++c) {
        const double value = valueIn(place.corners, place.weights, values, components, c);
        double& original = wanted[place.place * components + c];
        if (level == 0 && !isKnown) original = value;
        sum += (value - original) * (value - original);
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
