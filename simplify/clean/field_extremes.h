// The few values of a field that decide its scale, for a field that comes in pieces.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "simplify/mesh/tet_mesh.h"

namespace qtet {

class FieldExtremes {
 public:
  /// A field of this name, type and shape.
  explicit FieldExtremes(const MeshField& shape);

  void add(const MeshField& piece);
  [[nodiscard]] std::uint64_t nonFinite() const { return nonFinite_; }
  /// A field of a few values. They have the extents (extentsOf) and the range of all that were
  /// added. One of them is missing if one of those is.
  [[nodiscard]] MeshField field() const;

 private:
  /// A tuple, and the value that it was chosen for.
  struct Tuple {
    double value = std::numeric_limits<double>::quiet_NaN();
    std::vector<double> values;
  };

  MeshField shape_;
  std::uint64_t nonFinite_ = 0;
  std::vector<Tuple> lowest_, highest_;  // by component, the last one by length
};

}  // namespace qtet
