#include "proto/instants.h"

#include <algorithm>
#include <cassert>

namespace qtet {

Instants::Instants(const std::vector<ManifestField>& fields,
                   const std::vector<std::uint32_t>& wanted, std::span<const Series> all)
    : fields_(fields), wanted_(wanted) {
  for (const Series& series : all) {
    assert(series.fields.size() == series.times.size());
    for (std::size_t i = 0; i < series.fields.size(); ++i)
      if (std::ranges::binary_search(wanted, series.fields[i])) {
        instants_[static_cast<std::uint32_t>(series.fields[i])] = {series.times[i], series.name};
        times_.push_back(series.times[i]);
      }
  }
  for (const std::uint32_t f : wanted) {
    assert(f < fields.size());
    if (!instants_.contains(f)) taken_.emplace(fields[f].name, fields[f].association);
  }
  std::ranges::sort(times_);
  times_.erase(std::unique(times_.begin(), times_.end()), times_.end());
}

InstantFile Instants::fileAt(std::optional<double> time) const {
  InstantFile out{time, {}};
  for (const std::uint32_t f : wanted_) {
    const auto instant = instants_.find(f);
    if (instant == instants_.end()) {
      out.fields.push_back({f, fields_[f].name, false});
    } else if (instant->second.first == time) {
      const std::string& series = instant->second.second;
      const bool isTaken = taken_.contains({series, fields_[f].association});
      out.fields.push_back({f, isTaken ? fields_[f].name.text() : series, true});
    }
  }
  return out;
}

}  // namespace qtet
