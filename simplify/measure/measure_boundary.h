// How far the boundary of a level and that of the original are apart, both ways.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "proto/level_error.h"
#include "simplify/measure/farthest_point.h"
#include "simplify/measure/measure_samples.h"
#include "simplify/measure/measured_mesh.h"

namespace qtet {

class Workers;

struct BoundaryOptions {
  std::uint32_t samples = 0;  ///< places on the original's boundary, uniform by area
  /// The same on a level's: dearer, because they are searched again.
  std::uint32_t levelSamples = 0;
  /// Added to the squared distance of each place in the mean, in squared lattice steps.
  double squaredRounding = 0;
  std::uint64_t seed = 0;
  Workers* workers = nullptr;  ///< not null; the result does not depend on how many they are
  /// Where the mesh was reduced before. Its places on the original's boundary are taken, and its
  /// distances are added to those from the finest level.
  const OriginalSamples* before = nullptr;
};

/// Distances are over the original's diagonal. From the original, the same places are followed from
/// level to level. A place whose nearest triangle has not changed keeps its distance. That is exact
/// while each level is a subset of the one before, and an upper bound otherwise.
class BoundaryMeter {
 public:
  /// REQUIRES: `mesh` at its finest level. It must outlive this.
  BoundaryMeter(const MeasuredMesh& mesh, const BoundaryOptions& options);

  /// The step that `mesh` has just done.
  void follow();
  /// After follow(), before the distances are asked for. REQUIRES: the mesh's tree fits.
  void search();
  /// Mean over the samples; no point of the original's boundary is further than the maximum.
  [[nodiscard]] OneSidedDistance toLevel();
  /// Mean over samples of its own; no point of the level's boundary is further than the maximum.
  [[nodiscard]] OneSidedDistance toOriginal();

 private:
  struct Followed {
    Vector3 at;
    NearestTriangle nearest;
    bool isNear = true;  ///< else another triangle may be nearer
  };
  /// A triangle of the original and one of the level.
  struct FollowedTriangle {
    std::uint32_t near;
    double
        bound;  ///< the square of how far its farthest corner is from `near`; infinite if unknown
    /// A sharper bound that rests on more triangles of the level.
    double coveredBound;
    BoundTriangles cover;

    [[nodiscard]] double best() const { return std::min(bound, coveredBound); }
  };
  /// Squared: of the farthest place found, and what none is further than.
  struct Maximum {
    double found = 0, bound = 0;
  };

  void follow(std::uint32_t triangle);
  void followTriangles(const Fusion& fusion);
  /// Upper bounds of the squared maximum, where some place is as far as `squared`.
  [[nodiscard]] double boundToLevel(double squared);
  [[nodiscard]] double boundToOriginal(double squared);
  [[nodiscard]] Maximum farthestOf(std::span<const std::uint32_t> triangles, double squared);
  /// The squared distance that counts as none.
  [[nodiscard]] double nothing() const;

  const MeasuredMesh& mesh_;
  BoundaryOptions options_;
  std::vector<Followed> samples_;
  std::vector<FollowedTriangle> triangles_;  // of the original, in the order of its boundary
  // a triangle of the level, by what it was in the original: how far it is by now, an upper bound
  // of the square
  std::vector<double> triangleBounds_;
};

/// `nearest` made the nearest among the triangles that the fusion has put in the place of its own.
/// REQUIRES: the fusion holds nearest's triangle.
void followFusion(const MeasuredMesh& mesh, const Fusion& fusion, const Vector3& at,
                  NearestTriangle& nearest);

}  // namespace qtet
