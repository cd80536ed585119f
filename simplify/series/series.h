// The order in which the instants of a series are decoded.
#pragma once

#include <cassert>
#include <cstddef>
#include <optional>
#include <span>
#include <utility>
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

/// The numbers of the fields, with those of each series in the order of decoding. Before them come
/// one instant of each series and all other fields, in the order in which they are. That instant is
/// the one nearest to `opening`, or the first. It is decoded by itself.
[[nodiscard]] std::vector<std::size_t> seriesOrder(std::span<const MeshField> fields,
                                                   std::optional<double> opening = std::nullopt);

/// `its` in that order. REQUIRES: `order` has each number below its.size() once.
template <class T>
void putInOrder(const std::vector<std::size_t>& order, std::vector<T>& its) {
  assert(order.size() == its.size());
  std::vector<T> out;
  out.reserve(its.size());
  for (const std::size_t i : order) out.push_back(std::move(its[i]));
  its = std::move(out);
}

}  // namespace qtet
