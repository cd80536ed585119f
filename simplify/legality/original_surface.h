// The boundary as it was before the first fusion, and whether a tetrahedron leaves the solid behind
// it by more than a tolerance (ALGORITHM.md, "The envelope").
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "simplify/legality/distance_cells.h"
#include "simplify/mesh/fusion_mesh.h"
#include "simplify/mesh/triangle_tree.h"

namespace qtet {

/// The next smaller float, for bounds from above.
[[nodiscard]] inline float floatBelow(double x) {
  return std::nextafter(static_cast<float>(x), 0.0f);
}

/// Reading is safe from any thread.
class OriginalSurface {
 public:
  using Corners = std::array<Vector3, 4>;
  /// Cuts of one tetrahedron, unless said otherwise. A flat one is then in pieces an eighth as
  /// long. A piece that needs more is too large for the tolerance.
  static constexpr int kMaxCuts = 1 << 6;

  /// The surface of the mesh as it is now. Ghosts from `firstSeam` on are seams, not a boundary.
  explicit OriginalSurface(const FusionMesh& mesh, CellId firstSeam = kNoSeam);
  static constexpr CellId kNoSeam = ~CellId{0};

  /// By triangle, how far the solid may grow there, in lattice steps.
  struct Tolerances {
    std::vector<float> own;
    float least = 0, most = 0;  ///< of them

    /// The same at every triangle.
    Tolerances(const OriginalSurface& surface, double everywhere);
    explicit Tolerances(std::vector<float> own);
  };

  /// No point of the tetrahedron is outside the solid and further from every triangle than that
  /// one's tolerance. False also where that was not proved within `maxCuts`
  /// steps. `known`: of this surface alone. REQUIRES: corners in [0, 2^30)^3.
  [[nodiscard]] bool holds(const Corners& tetrahedron, const Tolerances& tolerances,
                           DistanceCells& known, int maxCuts = kMaxCuts) const;
  /// p is inside the solid, as far as doubles can tell, `nearest` being its nearest triangle. False
  /// where the surface is not a manifold at the nearest point.
  [[nodiscard]] bool isInside(const Vector3& p, const NearestTriangle& nearest) const;
  [[nodiscard]] const TriangleTree& tree() const { return *tree_; }
  /// By triangle of the tree; empty without seams.
  [[nodiscard]] std::span<const std::uint8_t> isSeam() const { return isSeam_; }

 private:
  static constexpr std::uint32_t kNobody = ~std::uint32_t{0};

  void collect(const FusionMesh& mesh, CellId firstSeam, std::vector<VertexId>& vertices);
  void findNeighbours();
  void findVertexNormals();
  [[nodiscard]] SignedDistance distanceOf(const LatticeCube& cube) const;
  [[nodiscard]] Vector3 unitNormal(std::uint32_t triangle) const;
  [[nodiscard]] Vector3 normalAt(const NearestTriangle& nearest) const;

  std::vector<LatticePoint> points_;
  std::vector<TriangleTree::Cell> triangles_;  // three of points_, and the ghost
  std::vector<std::uint8_t> isSeam_;           // by triangle, or empty
  // by triangle, across the edge from corner i to the next; kNobody where other than two triangles
  // meet
  std::vector<std::array<std::uint32_t, 3>> neighbours_;
  // by point: the normals of its triangles, each as long as its angle there; zero where the point
  // is singular
  std::vector<Vector3> vertexNormals_;
  std::unique_ptr<TriangleTree> tree_;
};

}  // namespace qtet
