#include "proto/instants.h"

#include <algorithm>
#include <span>

#include "proto/series.h"

namespace qtet {

Instants::Instants(const std::vector<ManifestField>& fields,
                   const std::vector<std::uint32_t>& wanted, std::size_t fewest)
    : fields_(fields), wanted_(wanted) {
  for (const Series& series : seriesOf(std::span(fields), fewest))
    for (std::size_t i = 0; i < series.fields.size(); ++i)
      if (std::ranges::binary_search(wanted, series.fields[i])) {
        instants_[static_cast<std::uint32_t>(series.fields[i])] = {series.times[i], series.name};
        times_.push_back(series.times[i]);
      }
  std::ranges::sort(times_);
  times_.erase(std::unique(times_.begin(), times_.end()), times_.end());
}

bool Instants::isTaken(const std::string& name, const std::string& association) const {
  return std::ranges::any_of(wanted_, [&](std::uint32_t f) {
    return !instants_.contains(f) && fields_[f].name == name &&
           fields_[f].association == association;
  });
}

InstantFile Instants::fileAt(std::optional<double> time) const {
  InstantFile out{time, {}};
  for (const std::uint32_t f : wanted_) {
    const auto instant = instants_.find(f);
    if (instant == instants_.end()) {
      out.fields.push_back({f, fields_[f].name, false});
    } else if (instant->second.first == time) {
      const std::string& series = instant->second.second;
      out.fields.push_back(
          {f, isTaken(series, fields_[f].association) ? fields_[f].name : series, true});
    }
  }
  return out;
}

}  // namespace qtet
