#include "simplify/measure/label_volumes.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "simplify/mesh/vector3.h"

namespace qtet {

LabelVolumes::LabelVolumes(const FusionHistory& history, const std::vector<std::uint32_t>& labels)
    : history_(history), labels_(labels), finest_(volumes()) {
  for (Volumes& of : finest_) {
    double all = 0;
    for (const auto& [value, volume] : of) all += volume;
    std::erase_if(of, [&](const auto& entry) { return entry.second < kSmallLabel * all; });
  }
}

double LabelVolumes::worst() const {
  assert(finest_.size() == labels_.size());
  const std::vector<Volumes> now = volumes();
  double worst = 0;
  for (std::size_t i = 0; i < finest_.size(); ++i)
    for (const auto& [value, volume] : finest_[i]) {
      const auto at = now[i].find(value);
      worst = std::max(worst, std::abs((at == now[i].end() ? 0 : at->second) / volume - 1));
    }
  return worst;
}

std::vector<LabelVolumes::Volumes> LabelVolumes::volumes() const {
  std::vector<Volumes> out(labels_.size());
  if (labels_.empty()) return out;
  for (std::size_t c = 0; c < history_.cells.size() && history_.cells[c][3] != kGhost; ++c) {
    if (!history_.live[c]) continue;
    const auto at = [&](std::size_t i) { return toVector(history_.points[history_.cells[c][i]]); };
    const double volume = dot(at(1) - at(0), cross(at(2) - at(0), at(3) - at(0)));
    for (std::size_t i = 0; i < labels_.size(); ++i)
      out[i][history_.values[labels_[i]][c]] += volume;
  }
  return out;
}

}  // namespace qtet
