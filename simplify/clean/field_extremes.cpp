#include "simplify/clean/field_extremes.h"

#include <cmath>

namespace qtet {

FieldExtremes::FieldExtremes(const MeshField& shape)
    : shape_(withoutValues(shape)),
      lowest_(shape.components + std::size_t{1}),
      highest_(shape.components + std::size_t{1}) {}

void FieldExtremes::add(const MeshField& piece) {
  shape_.labelNames.insert(piece.labelNames.begin(), piece.labelNames.end());
  const std::size_t n = shape_.components;
  for (std::size_t i = 0; i + n <= piece.values.size(); i += n) {
    const auto first = piece.values.begin() + static_cast<std::ptrdiff_t>(i);
    const auto offer = [&](std::size_t which, double value) {
      Tuple &low = lowest_[which], &high = highest_[which];
      if (!(value >= low.value)) low = {value, {first, first + static_cast<std::ptrdiff_t>(n)}};
      if (!(value <= high.value)) high = {value, {first, first + static_cast<std::ptrdiff_t>(n)}};
    };
    double squared = 0;
    for (std::size_t c = 0; c < n; ++c) {
      const double value = piece.values[i + c];
      squared += value * value;
      if (std::isfinite(value))
        offer(c, value);
      else
        ++nonFinite_;
    }
    if (n > 1 && std::isfinite(squared)) offer(n, squared);
  }
}

MeshField FieldExtremes::field() const {
  MeshField out = shape_;
  for (const std::vector<Tuple>* const some : {&lowest_, &highest_})
    for (const Tuple& tuple : *some)
      out.values.insert(out.values.end(), tuple.values.begin(), tuple.values.end());
  if (nonFinite_ > 0)
    out.values.insert(out.values.end(), shape_.components,
                      std::numeric_limits<double>::quiet_NaN());
  return out;
}

}  // namespace qtet
