#include "simplify/series/fewer_instants.h"

#include <algorithm>
#include <cassert>
#include <span>

#include "proto/series.h"
#include "simplify/series/series.h"

namespace qtet {
namespace {

/// How often a window was halved before the instant's turn came; 0: an end of a window.
std::vector<std::size_t> halvings(std::size_t instants) {
  std::vector<std::size_t> out(instants);
  for (const InstantStep& step : decodingOrder(instants)) {
    if (step.isAnchor) continue;
    const auto right = std::ranges::lower_bound(step.around, step.instant);
    assert(right != step.around.begin() && right != step.around.end());
    out[step.instant] = 1 + std::max(out[*(right - 1)], out[*right]);
  }
  return out;
}

}  // namespace

std::vector<std::vector<std::uint32_t>> fewerInstants(const Manifest& manifest,
                                                      std::span<const FieldShape> fields) {
  std::vector<std::size_t> halvingsOf(manifest.fields.size());
  for (const Series& series : manifest.series) {
    const std::vector<std::size_t> ofInstants = halvings(series.fields.size());
    for (std::size_t i = 0; i < ofInstants.size(); ++i)
      halvingsOf[series.fields[i]] = ofInstants[i];
    halvingsOf[*std::ranges::min_element(series.fields)] = 0;  // a viewer shows it first
  }
  std::vector<std::vector<std::uint32_t>> out;
  std::size_t before = halvingsOf.size();
  for (std::size_t most = halvingsOf.empty() ? 0 : std::ranges::max(halvingsOf); most-- > 0;) {
    std::vector<std::uint32_t> kept;
    for (std::uint32_t f = 0; f < halvingsOf.size(); ++f)
      if (halvingsOf[f] <= most) kept.push_back(f);
    kept = withParents(fields, kept);
    if (kept.size() < before) out.push_back(kept);
    before = kept.size();
  }
  return out;
}

}  // namespace qtet
