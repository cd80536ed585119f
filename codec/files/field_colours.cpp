#include "codec/files/field_colours.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "proto/limits.h"

namespace qtet {
namespace {

constexpr Colour kGrey = {0.75, 0.75, 0.75};
/// Viridis (van der Walt and Smith, 2015) at every eighth.
constexpr std::array<Colour, 9> kViridis = {{{0.267, 0.005, 0.329},
                                             {0.278, 0.176, 0.483},
                                             {0.231, 0.319, 0.545},
                                             {0.173, 0.449, 0.558},
                                             {0.128, 0.567, 0.551},
                                             {0.158, 0.684, 0.502},
                                             {0.369, 0.789, 0.383},
                                             {0.678, 0.864, 0.190},
                                             {0.993, 0.906, 0.144}}};

}  // namespace

Colour viridis(double fraction) {
  if (std::isnan(fraction)) return kGrey;
  const double at = std::clamp(fraction, 0.0, 1.0) * (kViridis.size() - 1);
  const auto i = std::min<std::size_t>(static_cast<std::size_t>(at), kViridis.size() - 2);
  Colour out{};
  for (std::size_t c = 0; c < 3; ++c)
    out[c] = kViridis[i][c] + (at - static_cast<double>(i)) * (kViridis[i + 1][c] - kViridis[i][c]);
  return out;
}

Colour linearLight(const Colour& colour) {
  Colour out{};
  for (std::size_t c = 0; c < 3; ++c)
    out[c] = colour[c] <= 0.04045 ? colour[c] / 12.92 : std::pow((colour[c] + 0.055) / 1.055, 2.4);
  return out;
}

double rangeFraction(std::span<const double> components, const std::array<double, 2>& range) {
  double value = 0;
  for (const double x : components) value = components.size() == 1 ? x : value + x * x;
  if (components.size() > 1) value = std::sqrt(value);
  const double span = range[1] - range[0];
  return span > 0 ? (value - range[0]) / span : std::isnan(value) ? value : 0.5;
}

double RangeFractions::operator[](VertexId v) const {
  if (!usable_) return std::numeric_limits<double>::quiet_NaN();
  const FieldInfo& field = mesh_.fields[field_];
  std::array<double, kMaxFieldComponents> value{};
  for (std::uint32_t c = 0; c < field.components; ++c)
    value[c] = field.value(c, mesh_.values[field_][std::size_t{v} * field.components + c]);
  return rangeFraction(std::span(value).first(field.components), field.range);
}

}  // namespace qtet
