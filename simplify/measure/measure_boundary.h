// How far the boundary of a level and that of the original are apart, both ways.
#pragma once

#include <cstdint>
#include <vector>

#include "proto/level_error.h"
#include "simplify/measure/measure_samples.h"
#include "simplify/measure/measured_mesh.h"

namespace qtet {

class Workers;

struct BoundaryOptions {
  std::uint32_t samples = 0;  ///< places on the original's boundary, uniform by area
  /// The same on a level's: dearer, because they are searched anew.
  std::uint32_t levelSamples = 0;
  /// For the maximum, on all triangles of a level; each has its corners, edge middles and centroid
  /// at least.
  std::uint32_t gridPoints = 0;
  std::uint64_t seed = 0;
  Workers* workers = nullptr;  ///< not null; the result does not depend on how many they are
};

/// Distances are over the original's diagonal. From the original, the same places are followed from
/// level to level; a place whose nearest triangle has not changed keeps its distance, which is
/// exact while each level is a subset of the one before, and an upper bound otherwise.
class BoundaryMeter {
 public:
  /// REQUIRES: `mesh` at its finest level. It must outlive this.
  BoundaryMeter(const MeasuredMesh& mesh, const BoundaryOptions& options);

  /// The step that `mesh` has just done.
  void follow();
  /// Mean over the samples; maximum over them and every vertex of the original's boundary.
  [[nodiscard]] OneSidedDistance toLevel();
  /// Mean over samples of its own; maximum over them and a grid on every triangle of the level.
  [[nodiscard]] OneSidedDistance toOriginal();

 private:
  struct Followed {
    Vector3 at;
    NearestTriangle nearest;
  };

  [[nodiscard]] double farthestVertex(double squared);
  [[nodiscard]] double farthestOfTriangles(double squared);
  /// At least the largest squared distance of the triangle's grid to the original; exact where it
  /// is above `enough`.
  [[nodiscard]] double farthestOnTriangle(std::uint32_t ghost, int parts, double enough) const;

  const MeasuredMesh& mesh_;
  BoundaryOptions options_;
  std::vector<Followed> samples_;
  // their distances are upper bounds; farthestVertex() searches where it matters
  std::vector<Followed> vertices_;
  // a triangle of the original: how far it is by now, an upper bound of the square
  std::vector<double> triangleBounds_;
};

/// `nearest` made the nearest among the triangles that the fusion has put in the place of its own.
/// REQUIRES: the fusion holds nearest's triangle.
void followFusion(const MeasuredMesh& mesh, const Fusion& fusion, const Vector3& at,
                  NearestTriangle& nearest);

}  // namespace qtet
