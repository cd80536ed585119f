// Whether a fusion keeps the mesh what it is: topology exactly (the link condition with the ghost
// vertex), no cell flipped, inside the boundary envelope, and how well shaped the new cells are
// (ALGORITHM.md, "Legality"). Topology, flips and the envelope without tolerance are exact.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "simplify/fuse/fusion_mesh.h"
#include "simplify/fuse/local_vertices.h"
#include "simplify/fuse/two_vectors.h"

namespace qtet {

class FullLinkCheck;
class RegionCheck;

/// Cells in the stars of a prey beyond which a fusion is not tried: a hub of a graded mesh would
/// make every fusion near it expensive.
inline constexpr std::size_t kMaxStarCells = 800;

struct FusionLimits {
  /// No new cell may be shaped worse than this or than a fifth of its star's worst, whichever is
  /// lower.
  double shapeFloor = 0;
  /// How far the boundary may leave the original solid, all fusions together, in lattice steps.
  double envelopeTolerance = 0;
  /// Cosine of the largest angle by which a boundary triangle may turn in one fusion; negative:
  /// any.
  double normalCosine = -1;
};

/// One thread's own; the mesh may be shared while nobody fuses.
class FusionCheck {
 public:
  explicit FusionCheck(const FusionMesh& mesh, const FusionLimits& limits = {});
  ~FusionCheck();

  /// Collects the boundary triangles of the prey's star, which is all that the envelope asks for.
  /// False when the star is too large.
  [[nodiscard]] bool gatherBoundary(const Prey& prey);
  /// Collects the rest of the star. False when that already rules the fusion out. REQUIRES
  /// gatherBoundary.
  [[nodiscard]] bool gatherRest();
  /// Both.
  [[nodiscard]] bool gather(const Prey& prey) { return gatherBoundary(prey) && gatherRest(); }
  /// Keeps topology: of the solid, of its boundary, and of every component of either; and the log
  /// can describe it. REQUIRES gather.
  [[nodiscard]] bool keepsTopology();

  /// p lies on the inner side of (or on) every boundary face of the star, or within what is left of
  /// the tolerance. REQUIRES gatherBoundary.
  [[nodiscard]] bool insideEnvelope(const LatticePoint& p) const;
  /// Moves p onto the planes of the boundary faces that it lies outside of, one after the other,
  /// until its lattice point is inside. REQUIRES gatherBoundary.
  [[nodiscard]] bool projectInside(Vector3 p, LatticePoint& inside) const;
  /// With the prey at p a cell of one of these prey vertices, one bit each, would flip or go flat,
  /// as far as doubles can tell. REQUIRES gatherBoundary.
  [[nodiscard]] bool flipsAt(const LatticePoint& p, std::uint32_t moving) const;
  /// How far the star's boundary may lie outside the original solid with the prey at p, in lattice
  /// steps. REQUIRES gatherBoundary, p inside the envelope.
  [[nodiscard]] float outsideAt(const LatticePoint& p) const;
  /// The worst shape among the affected cells with the prey at p (1 = regular, 0 = flat), or a
  /// negative number where p is not legal: a cell would flip or be squashed, or a boundary triangle
  /// turn too far; or where the shape is worse than `least`. REQUIRES gather.
  [[nodiscard]] double shapeAt(const LatticePoint& p, double least = 0) const;
  /// The worst shape in the star as it is. REQUIRES gather.
  [[nodiscard]] double oldShape() const { return oldShape_; }

  [[nodiscard]] const Star& star() const { return star_; }
  /// The same for good: until the next gather there is none here.
  void takeStar(Star& star) { std::swap(star_, star); }

 private:
  // The bases of two affected cells: volume and shape with an apex d, both relative to the first
  // prey vertex. The last may be one cell's twice.
  struct Bases {
    TwoVectors normal;   // of twice the area, towards the apex
    Pair height;         // normal . a corner
    TwoVectors corners;  // sum of the corners
    // of the three edges and the corners' distances from the origin
    Pair squares;
    std::array<std::uint32_t, 2> cell;  // indices into star_.affected
  };
  // A boundary triangle of the star.
  struct Face {
    CellId ghost;
    bool stays;           // one of its vertices is prey
    std::uint8_t moving;  // of a face that stays: which
  };
  // Of two faces, relative to the first prey vertex; where there is no second one, nothing is
  // beyond it.
  struct Planes {
    TwoVectors normal;
    Pair height, inverseLength;
  };

  template <std::uint32_t k>
  void addFaces();
  template <std::uint32_t k>
  [[nodiscard]] bool addStars();
  template <std::uint32_t k>
  [[nodiscard]] std::uint32_t sideOf(CellId c) const;
  void addStaying(std::size_t before, std::uint32_t from);
  template <std::uint32_t k>
  [[nodiscard]] bool addGoing(std::size_t count);
  void addFace(const Face& face, const Vector3& from);
  void measure();
  void addBases(std::uint32_t i, std::uint32_t j);
  void measureGoing(std::size_t i, std::size_t j);
  void see(const Pair& volume, const Pair& squares);
  [[nodiscard]] bool edgeKeepsTopology();
  [[nodiscard]] bool hasCommonChord();
  [[nodiscard]] bool hasCommonTriangle() const;
  [[nodiscard]] std::span<const std::array<std::uint32_t, 2>> ring() const {
    return std::span(ring_).first(star_.deleted.size());
  }
  [[nodiscard]] std::span<const Face> faces() const { return std::span(faces_).first(faceCount_); }
  template <class Visit>
  [[nodiscard]] bool anyFacing(const Vector3& d, double error, const Visit& visit) const;
  [[nodiscard]] bool isOutside(const Face& face, double side, const LatticePoint& p,
                               double error) const;
  [[nodiscard]] double distance(const Face& face, const LatticePoint& p) const;
  [[nodiscard]] bool flips(std::uint32_t i, CellId c, const Vector3& place, double error) const;
  [[nodiscard]] bool turnsTooFar(const Face& face, const LatticePoint& p) const;
  /// A point lies outside if and only if doubles say so.
  [[nodiscard]] bool isEnvelopeExact() const;
  [[nodiscard]] bool isAnyFacing(const Vector3& d) const;
  enum class WayBack : std::uint8_t { kInside, kOutside, kLost };
  [[nodiscard]] WayBack wayBack(const Vector3& p, const LatticePoint& inside, int step,
                                Vector3& back) const;
  [[nodiscard]] WayBack wayBackExactly(const Vector3& p, const LatticePoint& inside,
                                       Vector3& back) const;
  [[nodiscard]] double rounding(const Vector3& d, double placesReach) const;
  [[nodiscard]] bool onLattice(const LatticePoint& p) const;
  [[nodiscard]] double exactVolume6(std::uint32_t affected, const LatticePoint& p,
                                    bool& allowed) const;

  const FusionMesh& mesh_;
  FusionLimits limits_;
  Prey prey_;
  Star star_;
  LocalVertices vertices_;
  template <class T>
  using ByLocal = std::array<T, LocalVertices::kMax>;
  ByLocal<Vector3> places_;  // relative to the first prey vertex
  template <class T, std::size_t share>
  // no vectors, which would clear what is written anyway
  using ByCell = std::array<T, kMaxStarCells / share>;
  // affected cells, the prey vertex last, local
  ByCell<std::array<std::uint32_t, 4>, 1> turned_;
  // k = 2: the edges opposite the prey in deleted cells
  ByCell<std::array<std::uint32_t, 2>, 1> ring_;
  ByCell<CellId, 1> staying_, going_;  // of one prey vertex' star
  // affected cells that are no ghosts: indices into star_.affected
  ByCell<std::uint32_t, 1> innerCells_;
  ByCell<std::array<std::uint32_t, 4>, 1> goingCells_;  // deleted cells but ghosts, local
  ByCell<Bases, 4> bases_;
  ByCell<Face, 1> faces_;
  ByCell<Planes, 2> planes_;
  // k = 2: local vertices and affected cells of the first prey vertex; the second's come after them
  std::size_t firstVertices_ = 0, firstAffected_ = 0;
  // of bases_, of faces_, of innerCells_, of goingCells_
  std::size_t baseCount_ = 0, faceCount_ = 0, innerCount_ = 0, goingCount_ = 0;
  // What forbade the last point is asked first about the next: of bases_, and a cell of each prey
  // vertex.
  mutable std::size_t suspect_ = 0;
  static constexpr CellId kNoCell = ~CellId{0};
  mutable std::array<CellId, 4> flipped_{};
  Vector3 origin_{};                  // the first prey vertex
  double faceReach_ = 0, reach_ = 0;  // the largest coordinate of the faces, of all places_
  double worst_ = 1;                  // oldShape_ squared, as far as it is known
  double oldShape_ = 1;
  double floorSquared_ = 0;
  using Mask = std::uint64_t;  // of vertices of the ring
  static constexpr std::size_t kMaxRing = 64;
  struct RingVertex {
    Mask own = 0;     // its bit; none where it is not on the ring
    Mask joined = 0;  // its neighbours on the ring
    // the ring's other vertices that it has an edge to in the link of either prey vertex
    std::array<Mask, 2> chords{};
  };
  ByLocal<RingVertex> ringVertices_;
  std::unique_ptr<FullLinkCheck> full_;
  std::unique_ptr<RegionCheck> regions_;
};

}  // namespace qtet
