// The camera of the viewer's first picture (web-client/three/camera.ts, mesh_camera.ts).
#pragma once

#include <array>
#include <optional>

#include "codec/mesh/mesh.h"
#include "codec/picture/vector.h"
#include "proto/manifest.h"

namespace qtet {

[[nodiscard]] Vector unit(const Vector& a);

/// The least and the largest coordinates of the boundary's vertices.
struct Bounds {
  Vector low{}, high{};
};
/// REQUIRES: a boundary.
[[nodiscard]] Bounds boundsOf(const LatticeMesh& mesh);

/// Sees a mesh from the front right and from above, in perspective. The mesh, or the part of its
/// focus that is seen from outside, is fitted to a free area of 4 : 3.
class FirstCamera {
 public:
  /// REQUIRES: a boundary.
  FirstCamera(const LatticeMesh& mesh, const std::optional<Focus>& focus);

  /// To the right, upwards, and how far in front of the eye, in lattice steps.
  [[nodiscard]] Vector view(const Vector& lattice) const;
  /// The tangents of half the angles that the fitted part takes, horizontally and vertically.
  [[nodiscard]] std::array<double, 2> halfExtent() const { return halfExtent_; }
  /// Nothing is drawn that is nearer to the eye, in lattice steps.
  [[nodiscard]] double near() const { return near_; }
  /// A part is fitted; the mesh may reach beyond it.
  [[nodiscard]] bool showsPart() const { return showsPart_; }

 private:
  Vector right_{}, up_{}, towards_{}, target_{};
  double distance_ = 0, near_ = 0;
  std::array<double, 2> halfExtent_{};
  bool showsPart_ = false;
};

}  // namespace qtet
