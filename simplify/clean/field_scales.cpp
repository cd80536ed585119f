#include "simplify/clean/field_scales.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "proto/number_text.h"
#include "proto/series.h"

namespace qtet {
namespace {

FieldExtents unionOf(FieldExtents a, const FieldExtents& b) {
  a.include(b);
  return a;
}

double lowestOf(const FieldExtents& extents) { return std::ranges::min(extents.minimum); }
double highestOf(const FieldExtents& extents) { return std::ranges::max(extents.maximum); }

bool hasValues(const FieldExtents& extents) { return lowestOf(extents) <= highestOf(extents); }

/// An instant of a series.
struct Instant {
  std::size_t field = 0;
  FieldExtents own;
  double reach = 0;  ///< of the first one's values and its own
};

/// Takes the instants that share a scale off the list, which is by time, and gives their box. Those
/// that come after them in reach stay.
FieldExtents takeNear(std::vector<Instant>& instants, std::vector<Instant>& near) {
  const auto first = std::ranges::find_if(instants, hasValues, &Instant::own);
  if (first == instants.end()) {
    near = std::exchange(instants, {});
    return near.front().own;
  }
  FieldExtents box = first->own;
  for (Instant& instant : instants) instant.reach = unionOf(first->own, instant.own).largest();
  std::vector<const Instant*> byReach;
  for (const Instant& instant : instants) byReach.push_back(&instant);
  std::ranges::sort(byReach, {}, [](const Instant* instant) {
    return std::pair(instant->reach, instant);  // of one list
  });
  std::size_t count = 0;
  for (; count < byReach.size(); ++count) {
    const FieldExtents& own = byReach[count]->own;
    if (count >= (byReach.size() + 1) / 2 && isOutlying(own, box)) break;
    box.include(own);
  }
  std::vector<std::uint8_t> isNear(instants.size());
  for (const Instant* const instant : std::span(byReach).first(count))
    isNear[static_cast<std::size_t>(instant - instants.data())] = 1;
  std::vector<Instant> left;
  for (std::size_t i = 0; i < instants.size(); ++i)
    (isNear[i] != 0 ? near : left).push_back(std::move(instants[i]));
  instants = std::move(left);
  return box;
}

/// Gives the instants of a series of floats their scales.
void scaleSeries(std::span<const MeshField> fields, const Series& series, FieldScales& out) {
  std::vector<Instant> left;
  for (const std::size_t f : series.fields) left.push_back({f, out.scales[f].extents});
  for (bool isFirst = true; !left.empty(); isFirst = false) {
    std::vector<Instant> near;
    const FieldExtents box = takeNear(left, near);
    for (const Instant& instant : near) out.scales[instant.field].extents = box;
    for (const Instant& instant : left)
      if (isFirst) out.outlying.add(fields[instant.field], instant.own, box);
    std::erase_if(left, [&](const Instant& instant) {
      const bool areFew = areFewOutlying(fields[instant.field], box);
      if (areFew) out.scales[instant.field] = {box, true};
      return areFew;
    });
  }
}

std::string rangeText(const FieldExtents& extents) {
  return roundedText(lowestOf(extents)) + " to " + roundedText(highestOf(extents));
}

}  // namespace

bool isOutlying(const FieldExtents& own, const FieldExtents& others) {
  return others.largest() > 0 && unionOf(own, others).largest() > kOutlyingRange * others.largest();
}

bool areFewOutlying(const MeshField& field, const FieldExtents& others) {
  const double room = others.largest();
  const std::size_t n = field.components;
  std::size_t all = 0, inside = 0;
  for (std::size_t i = 0; i < field.values.size(); ++i) {
    const double value = field.values[i];
    if (!std::isfinite(value)) continue;
    ++all;
    inside += value >= others.minimum[i % n] - room && value <= others.maximum[i % n] + room;
  }
  return 2 * inside >= all;
}

void OutlyingInstants::add(const MeshField& field, const FieldExtents& own,
                           const FieldExtents& others) {
  const auto name = field.name.instant();
  if (!name) return;
  const auto at =
      found_.try_emplace({field.association, std::string(name->series)}, Found{own, others, {}});
  Found& found = at.first->second;
  found.own.include(own);
  found.times.push_back(name->time);
}

std::vector<std::string> OutlyingInstants::warnings() const {
  std::vector<std::string> out;
  for (const auto& [key, found] : found_) {
    std::vector<double> times = found.times;
    std::ranges::sort(times);
    out.push_back(key.first + " field " + key.second + ": its values at time " + shownTimes(times) +
                  " span " + rangeText(found.own) + ", and those of its other instants " +
                  rangeText(found.others) +
                  "; these keep their step, and the former have steps or bits of their own; if the "
                  "run went wrong there, leave that out with `time`");
  }
  return out;
}

FieldScales scalesOf(std::span<const MeshField> fields) {
  FieldScales out;
  for (const MeshField& field : fields) out.scales.push_back({extentsOf(field)});
  for (const Series& series : seriesOf(fields)) {
    if (isFloatType(fields[series.fields[0]].type)) {
      scaleSeries(fields, series, out);
      continue;
    }
    FieldExtents all = out.scales[series.fields[0]].extents;
    for (const std::size_t f : series.fields) all.include(out.scales[f].extents);
    for (const std::size_t f : series.fields) {
      FieldExtents& own = out.scales[f].extents;
      if (all.fitsExactly() || !own.fitsExactly()) own = all;
    }
  }
  return out;
}

ValueBounds withRanges(std::span<const MeshField> fields, const ValueBounds& bounds) {
  const FieldScales all = scalesOf(fields);
  const std::vector<std::optional<ValueBound>> known = valueBoundsOf(fields, bounds);
  std::map<std::string, ValueBound> least;  // by a key of the series
  for (std::size_t f = 0; f < fields.size(); ++f) {
    const auto name = fields[f].name.instant();
    if (!name || !known[f] || !known[f]->isOfRange()) continue;
    ValueBound bound = *known[f];
    bound.range = all.scales[f].extents.largest();
    const auto at =
        least.try_emplace(fields[f].association + ":" + std::string(name->series), bound);
    if (*bound.range < *at.first->second.range) at.first->second = bound;
  }
  ValueBounds out = bounds;
  out.insert(out.end(), least.begin(), least.end());
  return out;
}

Result<QuantisedField> quantiseBy(const FieldScale& scale, const MeshField& field, int bits,
                                  const std::optional<ValueBound>& bound) {
  const auto precisionIn = [&](const FieldExtents& extents) {
    FieldPrecision out{.bits = bits};
    if (bound)
      out.largestError = bound->isOfRange() ? bound->value / 100 * extents.largest() : bound->value;
    return out;
  };
  if (!scale.isExceeded) return quantiseField(field, scale.extents, precisionIn(scale.extents));
  Result<QuantisedField> out = quantiseFiner(field, scale.extents, precisionIn(scale.extents));
  if (out || !bound || !bound->isOfRange()) return out;
  const FieldExtents own = extentsOf(field);
  return quantiseField(field, own, precisionIn(own));
}

}  // namespace qtet
