// A point field as colours, where a picture or a file needs some and nobody chose: viridis over the
// field's range.
#pragma once

#include <array>

#include "codec/mesh/mesh.h"

namespace qtet {

/// Red, green and blue, 0 to 1, sRGB.
using Colour = std::array<double, 3>;

/// Viridis at a fraction of the range, clamped to [0, 1]; a grey for NaN.
[[nodiscard]] Colour viridis(double fraction);

/// What of a field's range a vertex's value (of vectors the magnitude) is: 0.5 where the range is
/// one value, NaN where there is no value, or no point field of this number. `mesh` must outlive
/// it.
class RangeFractions {
 public:
  RangeFractions(const LatticeMesh& mesh, std::size_t field)
      : mesh_(mesh),
        field_(field),
        usable_(field < mesh.fields.size() && !isCellField(mesh.fields[field])) {}
  [[nodiscard]] double operator[](VertexId v) const;

 private:
  const LatticeMesh& mesh_;
  std::size_t field_;
  bool usable_;
};

}  // namespace qtet
