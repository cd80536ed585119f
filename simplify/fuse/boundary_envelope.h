// The boundary envelope of a fusion (ALGORITHM.md, "Legality"): the boundary triangles of the
// prey's star, and where the prey may go for them.
#pragma once

#include <array>
#include <cstdint>

#include "simplify/fuse/fixed_list.h"
#include "simplify/fuse/fusion_mesh.h"
#include "simplify/fuse/local_star.h"
#include "simplify/fuse/two_vectors.h"

namespace qtet {

class BoundaryEnvelope {
 public:
  /// FusionLimits::envelopeTolerance and normalCosine.
  BoundaryEnvelope(const FusionMesh& mesh, double tolerance, double normalCosine)
      : mesh_(mesh), tolerance_(tolerance), normalCosine_(normalCosine) {}

  /// Collects the triangles. REQUIRES: the stars of the prey's vertices have kMaxStarCells cells at
  /// most, all together.
  void gather(const Prey& prey);

  /// p lies on the inner side of (or on) every triangle, or within what is left of the tolerance.
  [[nodiscard]] bool holds(const LatticePoint& p) const;
  /// Moves p onto the planes of the triangles that it lies outside of, one after the other, until
  /// its lattice point is inside.
  [[nodiscard]] bool project(Vector3 p, LatticePoint& inside) const;
  /// How far the star's boundary may lie outside the original solid with the prey at p, in lattice
  /// steps. REQUIRES: holds(p).
  [[nodiscard]] float outsideAt(const LatticePoint& p) const;
  /// With the prey at p a triangle turns further than it may.
  [[nodiscard]] bool turnsTooFar(const LatticePoint& p) const;

 private:
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
  void addFaces(const Prey& prey);
  void addFace(const Face& face, const Vector3& from);
  [[nodiscard]] std::span<const Planes> planes() const {
    return std::span(planes_).first((faces_.size() + 1) / 2);
  }
  [[nodiscard]] double rounding(const Vector3& d) const;
  template <class Visit>
  [[nodiscard]] bool anyFacing(const Vector3& d, double error, const Visit& visit) const;
  [[nodiscard]] bool isOutside(const Face& face, double side, const LatticePoint& p,
                               double error) const;
  [[nodiscard]] double distance(const Face& face, const LatticePoint& p) const;
  [[nodiscard]] bool turnsTooFar(const Face& face, const LatticePoint& p) const;
  /// A point lies outside if and only if doubles say so.
  [[nodiscard]] bool isExact() const;
  [[nodiscard]] bool isAnyFacing(const Vector3& d) const;
  enum class WayBack : std::uint8_t { kInside, kOutside, kLost };
  [[nodiscard]] WayBack wayBack(const Vector3& p, const LatticePoint& inside, int step,
                                Vector3& back) const;
  [[nodiscard]] WayBack wayBackExactly(const Vector3& p, const LatticePoint& inside,
                                       Vector3& back) const;

  const FusionMesh& mesh_;
  double tolerance_, normalCosine_;
  FixedList<Face, kMaxStarCells> faces_;
  std::array<Planes, kMaxStarCells / 2> planes_;  // of faces_
  Vector3 origin_{};                              // the first prey vertex
  double reach_ = 0;                              // the largest coordinate of the faces
};

}  // namespace qtet
