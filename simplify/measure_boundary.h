// How far the boundary of a level and that of the original are apart, both ways.
#pragma once

#include <cstdint>
#include <vector>

#include "proto/level_error.h"
#include "simplify/measure_samples.h"
#include "simplify/measured_mesh.h"

namespace qtet {

struct BoundaryOptions {
  std::uint32_t samples = 0;  ///< places a side, uniform by area
  /// Vertices, edge middles and centroids of the level's triangles looked at for the maximum: of every triangle, or of as many as this allows.
  std::uint32_t extremeSamples = 0;
  std::uint64_t seed = 0;
  int threads = 1;
};

/// Distances are over the original's diagonal. From the original, the same places are followed from level to level; a place whose nearest triangle
/// has not changed keeps its distance, which is exact while each level is a subset of the one before, and an upper bound otherwise.
class BoundaryMeter {
 public:
  /// REQUIRES: `mesh` at its finest level. It must outlive this.
  BoundaryMeter(const MeasuredMesh& mesh, const BoundaryOptions& options);

  /// The step that `mesh` has just done.
  void follow();
  /// Mean over the samples; maximum over them and every vertex of the original's boundary.
  [[nodiscard]] OneSidedDistance toLevel();
  [[nodiscard]] OneSidedDistance toOriginal() const;

 private:
  struct Followed {
    Point3 at;
    NearestTriangle nearest;
  };

  [[nodiscard]] double farthestVertex(double squared);
  [[nodiscard]] double farthestExtreme(double squared) const;

  const MeasuredMesh& mesh_;
  BoundaryOptions options_;
  std::vector<Followed> samples_;
  std::vector<Followed> vertices_;  // their distances are upper bounds; farthestVertex() searches where it matters
};

/// `nearest` made the nearest among the triangles that the fusion has put in the place of its own. REQUIRES: the fusion holds nearest's triangle.
void followFusion(const MeasuredMesh& mesh, const Fusion& fusion, const Point3& at, NearestTriangle& nearest);

}  // namespace qtet
