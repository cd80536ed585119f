#include "simplify/clean/value_bounds.h"

#include <algorithm>
#include <cmath>

#include "proto/field_key.h"
#include "proto/number_text.h"

namespace qtet {
namespace {

/// Whether the name means the fields that no other name does.
bool meansTheOthers(std::span<const MeshField> fields, const std::string& name) {
  return name == "all" && fieldsOfKey(fields, name).empty();
}

Status checkUnit(std::span<const MeshField> fields, const std::string& name,
                 const ValueBound& bound, const Units& units) {
  if (bound.unit.empty() || bound.isOfRange()) return {};
  const std::string given = "`errors` of " + name + " is in " + bound.unit;
  if (meansTheOthers(fields, name))
    return fail(ErrorCode::kBadValue,
                given + ", and fields have units of their own; give a share such as 0.1%");
  Manifest known;
  known.units = units;
  for (const std::uint32_t f : fieldsOfKey(fields, name)) {
    const std::string unit(unitOf(known, fields[f].name));
    if (unit == bound.unit) continue;
    return fail(ErrorCode::kBadValue,
                given + ", and the field " +
                    (unit.empty() ? "has no unit that is known; leave it out, or give it by `units`"
                                  : "is in " + unit));
  }
  return {};
}

}  // namespace

std::vector<std::optional<ValueBound>> valueBoundsOf(std::span<const MeshField> fields,
                                                     const ValueBounds& bounds) {
  std::vector<std::optional<ValueBound>> out(fields.size());
  for (const auto& [name, bound] : bounds)
    if (!meansTheOthers(fields, name))
      for (const std::uint32_t f : fieldsOfKey(fields, name)) out[f] = bound;
  const std::vector<std::optional<ValueBound>> named = out;
  for (const auto& [name, bound] : bounds)
    if (meansTheOthers(fields, name))
      for (std::size_t f = 0; f < out.size(); ++f)
        if (!named[f] && isFloatType(fields[f].type)) out[f] = bound;
  return out;
}

Status checkValueBounds(std::span<const MeshField> fields, const ValueBounds& bounds,
                        const Units& units) {
  for (const auto& [name, bound] : bounds) {
    if (!(bound.value > 0) || std::isinf(bound.value))
      return fail(ErrorCode::kBadValue, "`errors` of " + name + " is " + shortestText(bound.value) +
                                            "; give a finite number above 0");
    if (!meansTheOthers(fields, name) && fieldsOfKey(fields, name).empty())
      return fail(ErrorCode::kNotFound, "`errors`: the mesh carries no field '" + name + "'");
    if (Status s = checkUnit(fields, name, bound, units); !s) return s;
  }
  return {};
}

}  // namespace qtet
