#include "simplify/series/series.h"

#include <algorithm>
#include <cassert>
#include <numeric>

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
        assert(place > 0 && place < known.size());
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
  assert(out.size() == instants);
  return out;
}

std::vector<std::size_t> seriesOrder(std::span<const MeshField> fields,
                                     std::optional<double> opening) {
  std::vector<std::size_t> numbers(fields.size());
  std::iota(numbers.begin(), numbers.end(), std::size_t{0});
  const std::vector<Series> all = seriesOf(fields);
  for (const Series& series : all) {
    std::vector<std::size_t> ordered;
    for (const InstantStep& step : decodingOrder(series.fields.size()))
      ordered.push_back(series.fields[step.instant]);
    const std::size_t head = opening ? nearestTime(series.times, *opening) : 0;
    const auto at = std::ranges::find(ordered, series.fields[head]);
    assert(at != ordered.end());
    std::rotate(ordered.begin(), at, at + 1);
    std::vector<std::size_t> places = series.fields;
    std::ranges::sort(places);
    for (std::size_t i = 0; i < places.size(); ++i) numbers[places[i]] = ordered[i];
  }
  // of the places of a series the first one has its head
  const std::vector<bool> isLater = laterInstants(all, fields.size());
  std::vector<std::size_t> out;
  for (const bool later : {false, true})
    for (std::size_t f = 0; f < fields.size(); ++f)
      if (isLater[f] == later) out.push_back(numbers[f]);
  return out;
}

}  // namespace qtet
