// The scales of fields: which instants of a series share one, and which have their own.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "simplify/clean/quantise_field.h"
#include "simplify/clean/value_bounds.h"
#include "simplify/mesh/tet_mesh.h"

namespace qtet {

/// A series keeps one step while its values span at most so many times the range of most instants.
/// Every doubling costs the others a bit, so they keep all but two.
inline constexpr double kOutlyingRange = 4;

/// Whether values in `own` lead so far away from those in `others`. Values that are all equal have
/// no range to be compared with.
[[nodiscard]] bool isOutlying(const FieldExtents& own, const FieldExtents& others);

/// Whether half of the field's values or more lie within one range of `others`: a few lead away.
[[nodiscard]] bool areFewOutlying(const MeshField& field, const FieldExtents& others);

/// The instants whose values lead away from those of the others, over a whole run.
class OutlyingInstants {
 public:
  /// Ignores a field that is no instant.
  void add(const MeshField& field, const FieldExtents& own, const FieldExtents& others);
  /// A sentence a series.
  [[nodiscard]] std::vector<std::string> warnings() const;

 private:
  struct Found {
    FieldExtents own, others;
    std::vector<double> times;
  };
  std::map<std::pair<std::string, std::string>, Found> found_;  // by association and name
};

/// By what a field's values become integers.
struct FieldScale {
  FieldExtents extents;  ///< what the bits are for: the field's own, or those of its series
  /// Some values lie outside: they take the step of the others, and more bits.
  bool isExceeded = false;
};

struct FieldScales {
  std::vector<FieldScale> scales;  ///< one a field
  OutlyingInstants outlying;
};

/// Instants of floats share the box of their series. Those that are outlying among the nearer half
/// of the instants, seen from the first, have a box for themselves, or several. Integers that the
/// series' box is too large for keep their own where that stores them exactly.
[[nodiscard]] FieldScales scalesOf(std::span<const MeshField> fields);

/// The bounds with the ranges of these fields, for further instants of their series.
[[nodiscard]] ValueBounds withRanges(std::span<const MeshField> fields, const ValueBounds& bounds);

/// quantiseField by a scale. A share of the range is one of the largest extent of the scale,
/// or where values outside cannot hold that, of the field's own.
/// Errors: quantiseField's.
[[nodiscard]] Result<QuantisedField> quantiseBy(const FieldScale& scale, const MeshField& field,
                                                int bits,
                                                const std::optional<ValueBound>& bound = {});

}  // namespace qtet
