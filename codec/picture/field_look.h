// A field's values as the colours of the viewer's first picture: viridis over the automatic range,
// or a colour a label (web-client/viewer/settings/settings.ts, core/picture/labels.ts).
#pragma once

#include <array>
#include <cstddef>
#include <limits>

#include "codec/files/field_colours.h"

namespace qtet {

class FieldLook {
 public:
  /// Looks at the field `field` of `mesh`, which must outlive it; everything is plain if there is
  /// no such field. `isLabel`: the log says that it is a label.
  FieldLook(const LatticeMesh& mesh, std::size_t field, bool isLabel = false);

  /// The values belong to cells, else to vertices.
  [[nodiscard]] bool ofCells() const { return field_ != nullptr && isCellField(*field_); }
  /// A value's share of the field's range; vectors count by their magnitude. NaN where it is
  /// missing. `index` is a vertex or a cell.
  [[nodiscard]] double at(std::size_t index) const;
  /// The colour of such a share.
  [[nodiscard]] Colour colour(double share) const;

 private:
  [[nodiscard]] std::array<double, 2> automaticRange(const LatticeMesh& mesh) const;

  const FieldInfo* field_ = nullptr;
  const std::vector<std::int32_t>* values_ = nullptr;
  bool isLabels_ = false;
  /// The label of the first colour.
  double firstLabel_ = 0;
  /// The shares that the colours span.
  std::array<double, 2> range_ = {0, 1};
};

}  // namespace qtet
