// Labels: cell fields of integers that say what a cell is, such as its material (ALGORITHM.md,
// "Labels").
#pragma once

#include <cstddef>
#include <cstdint>
#include <set>
#include <vector>

#include "codec/mesh/mesh.h"
#include "proto/limits.h"

namespace qtet {

/// Values that a label has at most. A field of more numbers the cells, or what is as small.
inline constexpr std::size_t kMaxLabelValues = kMaxLabelNames;
/// A field is a label if more than this share of the faces inside lie between equal values. Six
/// tetrahedra of one hexahedron share half of their faces: so its number is none.
inline constexpr double kLabelNeighbours = 0.6;

/// Whether it holds integers of tetrahedra, stored exactly, of one component.
[[nodiscard]] bool isOneInteger(const FieldInfo& field);

/// Whether the field can be a label: isOneInteger, and of 2 to kMaxLabelValues values.
/// REQUIRES: field < mesh.fields.size().
[[nodiscard]] bool canBeLabel(const LatticeMesh& mesh, std::size_t field);

/// The fields that are labels, ascending. They can be, and have names of values, a usual name of
/// one, or neighbours that mostly agree. The numbers of processes are none. All instants of a
/// series are labels, or none.
[[nodiscard]] std::vector<std::size_t> labelsOf(const LatticeMesh& mesh);

/// Finds canBeLabel and labelsOf of a mesh that comes in pieces. Faces between pieces do not count.
class LabelFinder {
 public:
  explicit LabelFinder(std::vector<FieldInfo> fields);

  void add(const LatticeMesh& piece);
  [[nodiscard]] bool canBe(std::size_t field) const;
  [[nodiscard]] std::vector<std::size_t> labels() const;
  /// Ascending, kMaxLabelValues + 1 at most. REQUIRES: isOneInteger(fields[field]).
  [[nodiscard]] const std::set<std::int32_t>& valuesOf(std::size_t field) const {
    return values_[field];
  }

 private:
  std::vector<FieldInfo> fields_;
  std::vector<std::set<std::int32_t>> values_;  // of each field that is one integer
  std::size_t faces_ = 0;
  std::vector<std::size_t> equal_;  // faces between equal values, by field
};

/// The names of values that are among the integers.
[[nodiscard]] LabelNames namesOfValues(const FieldInfo& info,
                                       const std::vector<std::int32_t>& integers);

/// The faces between cells of different labels, outward from the lower one, by their smallest
/// vertices. REQUIRES: a cell field of one component.
[[nodiscard]] std::vector<Triangle> interfacesOf(const LatticeMesh& mesh, std::size_t field);

}  // namespace qtet
