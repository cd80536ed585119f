// A point field as colours, where a picture or a file needs some and nobody chose: viridis over the
// field's range.
#pragma once

#include <array>
#include <span>

#include "codec/mesh/mesh.h"

namespace qtet {

/// Red, green and blue, 0 to 1, sRGB.
using Colour = std::array<double, 3>;

/// Viridis at a fraction of the range, clamped to [0, 1]; a grey for NaN.
[[nodiscard]] Colour viridis(double fraction);

/// sRGB's numbers as linear light (IEC 61966-2-1), which glTF and OpenUSD mean by a colour.
[[nodiscard]] Colour linearLight(const Colour& colour);

/// The value's place in the range, 0 to 1; several components count by their magnitude. 0.5 if the
/// range is one value, NaN if the value is NaN.
[[nodiscard]] double rangeFraction(std::span<const double> components,
                                   const std::array<double, 2>& range);

/// The place of a vertex's value in its field's range; vectors count by their magnitude. 0.5 if the
/// range is one value. NaN if there is no value, or no point field of this number. `mesh` must
/// outlive it.
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
