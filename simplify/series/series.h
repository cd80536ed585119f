// The order in which the instants of a series are decoded.
#pragma once

#include <cstddef>
#include <vector>

#include "proto/series.h"
#include "simplify/mesh/tet_mesh.h"

namespace qtet {

/// Instants of a window: the first is decoded by itself or from the window before. Seeking to an
/// instant takes those of its window that it is predicted from; with more there would be more.
inline constexpr std::size_t kWindow = 8;

/// Anchors in a row that may rest on the one before: seeking decodes all of them.
inline constexpr std::size_t kAnchorsInARow = 4;

/// An instant in the order of decoding, with the instants that come before it and lie around it.
struct InstantStep {
  std::size_t instant;
  /// By time, of its window: the nearest on each side and the next. An anchor has the one before.
  std::vector<std::size_t> around;
  bool isAnchor = false;
};

/// The order in which so many instants are decoded: the ends of a window, and then always the
/// middle between two. Every second instant is a film of half the rate.
[[nodiscard]] std::vector<InstantStep> decodingOrder(std::size_t instants);

/// Puts each series' fields into the order of decoding. Before them come the first instant of each
/// series and all other fields, in the order in which they are.
void orderSeries(std::vector<MeshField>& fields);

}  // namespace qtet
