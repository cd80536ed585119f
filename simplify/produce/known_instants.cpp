#include "simplify/produce/known_instants.h"

#include <algorithm>
#include <cassert>
#include <iterator>
#include <vector>

#include "proto/number_text.h"
#include "proto/series.h"
#include "simplify/read/steps/common_type.h"
#include "simplify/series/series.h"

namespace qtet {

KnownInstants::KnownInstants(const Manifest& manifest) {
  for (const ManifestField& field : manifest.fields)
    if (const auto name = field.name.instant()) {
      OneSeries& series = series_[{field.association, std::string(name->series)}];
      series.components = field.components, series.type = field.type;
      series.times.insert(name->time);
      times_.insert(name->time);
      last_ = std::max(last_.value_or(name->time), name->time);
    }
}

bool KnownInstants::hasTime(const std::set<double>& times, double time) {
  const auto behind = times.lower_bound(time);
  return (behind != times.end() && isSameTime(*behind, time)) ||
         (behind != times.begin() && isSameTime(*std::prev(behind), time));
}

const KnownInstants::OneSeries* KnownInstants::seriesOf(const MeshField& field) const {
  const auto name = field.name.instant();
  assert(name);
  const auto at = series_.find({field.association, std::string(name->series)});
  return at == series_.end() ? nullptr : &at->second;
}

bool KnownInstants::has(const MeshField& field) const {
  const OneSeries* const series = seriesOf(field);
  return series != nullptr && hasTime(series->times, field.name.instant()->time);
}

Status KnownInstants::add(MeshField& field, const std::string& file) {
  const auto name = field.name.instant();
  assert(name);
  OneSeries& series = series_[{field.association, std::string(name->series)}];
  if (series.times.empty()) series.components = field.components, series.type = field.type;
  const bool areFloats = isFloatType(field.type) && isFloatType(series.type);
  const bool holdsIt = areFloats || commonType(series.type, field.type) == series.type;
  if (field.components != series.components || !holdsIt)
    return fail(ErrorCode::kBadInput,
                file + ": " + field.name + " has " + std::to_string(field.components) + " x " +
                    field.type + ", its series in the log " + std::to_string(series.components) +
                    " x " + series.type +
                    ", which does not hold it; write it as the earlier steps are");
  if (field.type != series.type && series.type == "float32")
    for (double& value : field.values) value = static_cast<float>(value);
  field.type = series.type;
  series.times.insert(name->time);
  times_.insert(name->time);
  if (last_ && name->time < *last_) between_.insert(name->time);
  return {};
}

std::string KnownInstants::warning() const {
  if (between_.empty()) return {};
  return std::to_string(between_.size()) + (between_.size() == 1 ? " step lies" : " steps lie") +
         " before time " + shortestText(*last_) + ", the last one of the log (" +
         shownTimes(std::vector<double>(between_.begin(), between_.end())) +
         "): do they belong to one run?";
}

}  // namespace qtet
