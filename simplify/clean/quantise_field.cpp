#include "simplify/clean/quantise_field.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <limits>

#include "proto/field_name.h"
#include "proto/limits.h"
#include "proto/number_text.h"
#include "proto/rounding_error.h"

namespace qtet {
namespace {

/// The range of the values, or of the vectors' lengths; vectors with a component that is not finite
/// do not count.
std::array<double, 2> rangeOf(const MeshField& field) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (std::size_t i = 0; i + field.components <= field.values.size(); i += field.components) {
    double value = field.values[i];
    if (field.components > 1) {
      double sum = 0;
      for (std::size_t c = 0; c < field.components; ++c)
        sum += field.values[i + c] * field.values[i + c];
      value = std::sqrt(sum);
    }
    if (!std::isfinite(value)) continue;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  if (low > high) return {0, 0};
  return {low, high};
}

/// Each component's least value; 0 where there is none.
std::vector<double> minimumOf(const FieldExtents& extents) {
  std::vector<double> out;
  for (const double low : extents.minimum)
    // Minus zero would be another number in the manifest, and the same one everywhere else.
    out.push_back(std::isfinite(low) && low != 0 ? low : 0);
  return out;
}

int bitsFor(double extent) {
  return std::max(kMinFieldBits,
                  static_cast<int>(std::bit_width(static_cast<std::uint64_t>(extent))));
}

std::uint64_t nonFiniteOf(const MeshField& field) {
  return static_cast<std::uint64_t>(
      std::ranges::count_if(field.values, [](double value) { return !std::isfinite(value); }));
}

/// The rounding to keep room for beside half a step. Later instants of a series may take more bits
/// for larger values (quantiseAs), and so more rounding; that has room where it costs little.
double roomForRounding(const FieldInfo& info, double extent, double bound) {
  constexpr double kLaterExtents = 64;
  double magnitude = 0;
  for (const double low : info.minimum) magnitude = std::max(magnitude, std::abs(low));
  const double later = typeRounding(info.type, magnitude + kLaterExtents * extent);
  if (info.name.isInstant() && later < bound / 8) return later;
  return typeRounding(info.type, magnitude + 2 * extent);  // bits hold less than two extents
}

std::unexpected<Error> tooFine(const FieldInfo& info, double extent, double bound,
                               double rounding) {
  const double step = std::max(extent / (std::ldexp(1.0, kMaxFieldBits) - 1), kFinestFieldStep);
  const double finest = step / 2 + rounding;
  return fail(ErrorCode::kBadValue,
              "field " + info.name + " cannot be within " + roundedText(bound) + ": " +
                  std::to_string(kMaxFieldBits) + " bits of its " + info.type +
                  " values allow an error of " + roundedText(1.001 * finest) +
                  "; give that or more by `errors`, or keep its own values by `lossless`");
}

/// One value takes any step. That of an instant stays 1, by which others do not take it for theirs.
void takeBoundOfConstant(double bound, FieldInfo& info) {
  info.bits = kMinFieldBits;
  if (const double rounding = roomForRounding(info, 1, bound);
      bound > rounding && !info.name.isInstant())
    info.step = std::min(1.0, 2 * (bound - rounding));
}

/// Step and bits of a box of this largest extent.
Status takeBound(double extent, double bound, FieldInfo& info) {
  if (extent <= 0) {
    takeBoundOfConstant(bound, info);
    return {};
  }
  assert(std::isfinite(extent) && info.minimum.size() == info.components);
  const double rounding = roomForRounding(info, extent, bound);
  const double most = std::ldexp(1.0, kMaxFieldBits) - 1;
  if (!(bound > rounding)) return tooFine(info, extent, bound, rounding);
  // one more where the quotient itself was rounded down
  for (double steps = std::max(1.0, std::ceil(extent / (2 * (bound - rounding)))); steps <= most;
       ++steps) {
    info.step = std::max(extent / steps, kFinestFieldStep);
    info.bits = bitsFor(steps);
    if (largestRoundingError(info) <= bound) return {};
    if (info.step == kFinestFieldStep) break;
  }
  return tooFine(info, extent, bound, rounding);
}

/// The integers of `out.info`, and which are missing. REQUIRES: out.nonFinite.
void place(const MeshField& field, QuantisedField& out) {
  assert(out.values.empty() && out.info.step > 0 && out.info.bits <= kMaxFieldBits);
  assert(field.components > 0 && field.values.size() % field.components == 0);
  out.values.reserve(field.values.size());
  if (out.nonFinite > 0) out.missing.assign(field.values.size(), 0);
  for (std::size_t i = 0; i < field.values.size(); ++i) {
    const auto component = static_cast<std::uint32_t>(i % field.components);
    const bool finite = std::isfinite(field.values[i]);
    assert(finite || out.nonFinite > 0);
    if (!finite) out.missing[i] = 1;
    out.values.push_back(finite ? fieldInteger(out.info, component, field.values[i]) : 0);
  }
}

}  // namespace

FieldExtents extentsOf(const MeshField& field) {
  const std::size_t components = field.components;
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  FieldExtents out{std::vector<double>(components, kInfinity),
                   std::vector<double>(components, -kInfinity)};
  for (std::size_t i = 0; i < field.values.size(); ++i) {
    const double value = field.values[i];
    if (!std::isfinite(value)) continue;
    out.minimum[i % components] = std::min(out.minimum[i % components], value);
    out.maximum[i % components] = std::max(out.maximum[i % components], value);
  }
  return out;
}

bool haveOneScale(const FieldInfo& a, const FieldInfo& b) {
  assert(a.step > 0 && b.step > 0);
  return a.step == b.step && a.minimum == b.minimum;
}

FieldExtents extentsOf(const FieldInfo& scale) {
  FieldExtents out{scale.minimum, scale.minimum};
  for (double& most : out.maximum) most += scale.step * (std::ldexp(1.0, scale.bits) - 1);
  return out;
}

double FieldExtents::largest() const {
  double out = 0;
  for (std::size_t c = 0; c < minimum.size(); ++c) out = std::max(out, maximum[c] - minimum[c]);
  return out;
}

bool FieldExtents::fitsExactly() const { return largest() < std::ldexp(1.0, kMaxFieldBits); }

void FieldExtents::include(const FieldExtents& other) {
  assert(minimum.size() == other.minimum.size());
  for (std::size_t c = 0; c < minimum.size(); ++c) {
    minimum[c] = std::min(minimum[c], other.minimum[c]);
    maximum[c] = std::max(maximum[c], other.maximum[c]);
  }
}

std::int32_t fieldInteger(const FieldInfo& info, std::uint32_t component, double value) {
  assert(std::isfinite(value) && component < info.components);
  assert(info.step > 0 && info.minimum.size() == info.components);
  const double highest = std::ldexp(1.0, info.bits) - 1;
  return static_cast<std::int32_t>(
      std::clamp(std::floor((value - info.minimum[component]) / info.step + 0.5), 0.0, highest));
}

Result<QuantisedField> quantiseField(const MeshField& field, const FieldExtents& extents,
                                     const FieldPrecision& precision) {
  const double largest = extents.largest();
  if (!std::isfinite(largest)) {
    return fail(
        ErrorCode::kBadInput,
        "field " + field.name + " spans more than the largest float64; leave it out with `fields`");
  }
  QuantisedField out;
  out.nonFinite = nonFiniteOf(field);
  out.exact = !isFloatType(field.type) && extents.fitsExactly();
  out.info = FieldInfo{.name = field.name,
                       .components = field.components,
                       .type = field.type,
                       .association = field.association,
                       .bits = out.exact ? bitsFor(largest) : precision.bits,
                       .step = 1,
                       .minimum = minimumOf(extents),
                       .range = rangeOf(field),
                       .hasMissing = out.nonFinite > 0,
                       .labelNames = field.labelNames};
  if (!out.exact && precision.largestError) {
    if (Status s = takeBound(largest, *precision.largestError, out.info); !s)
      return std::unexpected(s.error());
  } else if (!out.exact && largest > 0) {
    out.info.step = std::max(largest / (std::ldexp(1.0, precision.bits) - 1), kFinestFieldStep);
  }
  place(field, out);
  return out;
}

Result<QuantisedField> quantiseFiner(const MeshField& field, const FieldExtents& extents,
                                     const FieldPrecision& precision) {
  Result<QuantisedField> others = quantiseField({.name = field.name,
                                                 .components = field.components,
                                                 .type = field.type,
                                                 .values = {},
                                                 .association = field.association},
                                                extents, precision);
  if (!others) return others;
  const double mostError = precision.largestError.value_or(std::numeric_limits<double>::infinity());
  if (std::optional<QuantisedField> there = quantiseAs(others->info, field);
      there && largestRoundingError(there->info) <= mostError)
    return *there;
  const FieldExtents own = extentsOf(field);
  if (precision.largestError) return quantiseField(field, own, precision);
  int needed = precision.bits;
  while (needed < kMaxFieldBits &&
         own.largest() > others->info.step * (std::ldexp(1.0, needed) - 1))
    ++needed;
  return quantiseField(field, own, FieldPrecision{.bits = needed});
}

std::optional<QuantisedField> quantiseAs(const FieldInfo& scale, const MeshField& field) {
  if (scale.components != field.components || scale.type != field.type) return std::nullopt;
  const FieldExtents extents = extentsOf(field);
  int bits = scale.bits;
  for (std::size_t c = 0; c < scale.components; ++c) {
    const auto isBeyond = [&] {
      return extents.maximum[c] - scale.minimum[c] > scale.step * (std::ldexp(1.0, bits) - 0.5);
    };
    while (isBeyond() && bits < kMaxScaleBits) ++bits;
    if (isBeyond() || extents.minimum[c] < scale.minimum[c] - 0.5 * scale.step) return std::nullopt;
  }
  QuantisedField out;
  out.nonFinite = nonFiniteOf(field);
  out.exact = !isFloatType(field.type) && scale.step == 1;
  out.info = scale;
  out.info.bits = bits;
  out.info.name = field.name, out.info.association = field.association;
  out.info.range = rangeOf(field), out.info.hasMissing = out.nonFinite > 0;
  place(field, out);
  return out;
}

}  // namespace qtet
