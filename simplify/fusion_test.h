// Whether a fusion keeps the mesh what it is: topology exactly (the link condition with the ghost vertex), no cell flipped, inside the boundary
// envelope, and how well shaped the new cells are (ALGORITHM.md, "Legality"). Topology, flips and the envelope without tolerance are exact.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "simplify/fusion_mesh.h"
#include "simplify/local_vertices.h"

namespace qtet {

class FullLinkTest;
class RegionTest;

/// Cells in the stars of a prey beyond which a fusion is not tried: a hub of a graded mesh would make every fusion near it expensive.
inline constexpr std::size_t kMostStarCells = 800;

struct FusionLimits {
  /// No new cell may be shaped worse than this or than a fifth of its star's worst, whichever is lower.
  double shapeFloor = 0;
  /// How far the boundary may leave the original solid, all fusions together, in lattice steps.
  double envelopeTolerance = 0;
  /// Cosine of the largest angle by which a boundary triangle may turn in one fusion; negative: any.
  double normalCosine = -1;
};

/// One thread's own; the mesh may be shared while nobody fuses.
class FusionTest {
 public:
  explicit FusionTest(const FusionMesh& mesh, const FusionLimits& limits = {});
  ~FusionTest();

  /// Collects the star of the prey. False when it is too large or already rules the fusion out.
  [[nodiscard]] bool gather(const Prey& prey);
  /// Keeps topology: of the solid, of its boundary, and of every component of either; and the log can describe it. REQUIRES gather.
  [[nodiscard]] bool keepsTopology();

  /// p lies on the inner side of (or on) every boundary face of the star, or within what is left of the tolerance. REQUIRES gather.
  [[nodiscard]] bool insideEnvelope(const LatticePoint& p) const;
  /// Moves p onto the planes of the boundary faces that it lies outside of, one after the other, until its lattice point is inside.
  [[nodiscard]] bool projectInside(Vector3 p, LatticePoint& inside) const;
  /// How far the star's boundary may lie outside the original solid with the prey at p, in lattice steps. REQUIRES gather, p inside the envelope.
  [[nodiscard]] float outsideAt(const LatticePoint& p) const;
  /// The worst shape among the affected cells with the prey at p (1 = regular, 0 = flat), or a negative number where p is not legal: a cell
  /// would flip or be squashed, or a boundary triangle turn too far. REQUIRES gather.
  [[nodiscard]] double shapeAt(const LatticePoint& p) const;
  /// The worst shape in the star as it is. REQUIRES gather.
  [[nodiscard]] double oldShape() const { return oldShape_; }

  [[nodiscard]] const Star& star() const { return star_; }

 private:
  // The base of an affected cell: volume and shape with an apex d, both relative to the first prey vertex.
  struct Base {
    Vector3 normal;      // of twice the area, towards the apex
    double height;       // normal . a corner
    Vector3 corners;     // sum of the corners
    double squares;      // of the three edges and the corners' distances from the origin
    std::uint32_t cell;  // index into star_.affected
  };
  struct GhostCell {
    std::array<std::uint32_t, 4> local;  // the ghost last
    CellId cell;
    bool stays;  // is affected
  };
  // A boundary triangle of the star, counter-clockwise seen from outside.
  struct Face {
    Vector3 normal;
    double height;
    std::array<VertexId, 3> vertex;
    std::array<Vector3, 3> corner;  // of an affected face the one that moves is the last
    double outside;                 // FusionMesh::outside
    bool stays = false;
  };

  void addCell(CellId c, const std::array<std::uint32_t, 4>& local, int shared, std::size_t at);
  void addBase(const std::array<std::uint32_t, 4>& local, std::size_t cell);
  void addFace(const GhostCell& ghost);
  void measure();
  void measureShape();
  [[nodiscard]] bool edgeKeepsTopology();
  [[nodiscard]] bool hasCommonChord();
  [[nodiscard]] bool isOutside(const Face& face, const Vector3& d, const LatticePoint& p) const;
  [[nodiscard]] static double distance(const Face& face, const Vector3& d);
  [[nodiscard]] double rounding(const Vector3& d) const;
  [[nodiscard]] bool onLattice(const LatticePoint& p) const;
  [[nodiscard]] double exactVolume6(const Base& base, const LatticePoint& p, bool& allowed) const;

  const FusionMesh& mesh_;
  FusionLimits limits_;
  Prey prey_;
  Star star_;
  LocalVertices vertices_;
  std::vector<Vector3> places_;                       // by local vertex, relative to the first prey vertex
  std::vector<std::uint8_t> sides_;                   // by local vertex: bit i = in the link of prey vertex i
  std::vector<std::array<std::uint32_t, 4>> turned_;  // affected cells, the prey vertex last, local
  std::vector<GhostCell> ghosts_;
  std::vector<std::array<std::uint32_t, 2>> ring_;        // k = 2: the edges opposite the prey in deleted cells
  std::vector<std::array<std::uint32_t, 4>> goingCells_;  // deleted cells, local
  std::vector<Base> bases_;
  std::vector<Face> faces_;
  double reach_ = 0;  // the largest coordinate of places_
  double oldShape_ = 1;
  double floorSquared_ = 0;
  std::vector<std::array<std::uint32_t, 2>> ringNeighbours_;
  std::vector<std::array<std::uint32_t, 2>> chords_;
  std::unique_ptr<FullLinkTest> full_;
  std::unique_ptr<RegionTest> regions_;
};

}  // namespace qtet
