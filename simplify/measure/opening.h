// The first picture of a mesh: it must show something.
#pragma once

#include <optional>

#include "codec/mesh/mesh.h"
#include "proto/manifest.h"

namespace qtet {

/// The field whose colours tell most apart on the boundary that a viewer's first camera sees, the
/// first one of equals. With a focus only what lies near it counts. Without one, if that boundary
/// looks uniform: the cut in the middle across an axis, and the field, that show most. None if the
/// first field shows most without a cut, or nothing does.
///
/// The number of colours is 1 / sum of p^2 (inverse Simpson index), where p is the share of
/// the area that has one of 256 colours. The colours span the values. If the middle 96 % of them
/// take less than 0.4 of that, they span these. The viewer's automatic range counts volumes, and
/// cuts earlier. The colours of an instant span the values of its whole series. Nothing but
/// + - * / and sqrt decides.
[[nodiscard]] std::optional<Opening> openingOf(const LatticeMesh& mesh,
                                               const std::optional<Focus>& focus = std::nullopt);

/// The time at which the series show most by the same measure, the first one of equals. Eight times
/// at most are looked at. None if their first instants and the other fields show two thirds as
/// much: a run is then seen from its beginning. REQUIRES: the first instants come before the
/// others.
[[nodiscard]] std::optional<double> openingTime(const LatticeMesh& mesh,
                                                const std::optional<Focus>& focus = std::nullopt);

}  // namespace qtet
