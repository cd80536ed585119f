#include "simplify/series/series.h"

#include <algorithm>
#include <span>
#include <utility>

namespace qtet {

std::vector<InstantStep> decodingOrder(std::size_t instants) {
  std::vector<InstantStep> out;
  if (instants == 0) return out;
  out.push_back({0, {}, true});
  for (std::size_t begin = 0; begin + 1 < instants; begin += kWindow) {
    const std::size_t end = std::min(begin + kWindow, instants - 1);
    out.push_back({end, {begin}, true});
    std::vector<std::size_t> known{begin, end};  // ascending
    while (known.size() < end - begin + 1) {
      std::vector<std::size_t> more;
      for (std::size_t i = 0; i + 1 < known.size(); ++i)
        if (known[i + 1] - known[i] > 1) more.push_back((known[i] + known[i + 1]) / 2);
      for (const std::size_t instant : more) {
        const auto right = std::ranges::lower_bound(known, instant);
        const auto place = static_cast<std::size_t>(right - known.begin());
        // two on each side, or what there is
        std::size_t first = place >= 2 ? place - 2 : 0;
        first = std::min(first, known.size() >= 4 ? known.size() - 4 : 0);
        const std::size_t count = std::min<std::size_t>(4, known.size());
        out.push_back({instant,
                       {known.begin() + static_cast<std::ptrdiff_t>(first),
                        known.begin() + static_cast<std::ptrdiff_t>(first + count)},
                       false});
      }
      known.insert(known.end(), more.begin(), more.end());
      std::ranges::sort(known);
    }
  }
  return out;
}

void orderSeries(std::vector<MeshField>& fields) {
  for (const Series& series : seriesOf(std::span<const MeshField>(fields))) {
    std::vector<std::size_t> places = series.fields;
    std::ranges::sort(places);
    std::vector<MeshField> ordered;
    for (const InstantStep& step : decodingOrder(series.fields.size()))
      ordered.push_back(std::move(fields[series.fields[step.instant]]));
    for (std::size_t i = 0; i < places.size(); ++i) fields[places[i]] = std::move(ordered[i]);
  }
  const std::vector<bool> isLater = laterInstants(std::span<const MeshField>(fields));
  std::vector<MeshField> out;
  for (const bool later : {false, true})
    for (std::size_t f = 0; f < fields.size(); ++f)
      if (isLater[f] == later) out.push_back(std::move(fields[f]));
  fields = std::move(out);
}

}  // namespace qtet
