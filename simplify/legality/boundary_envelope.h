// The boundary envelope of a fusion (ALGORITHM.md, "Legality"): the boundary triangles of the
// prey's star, and where the prey may go for them.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "simplify/legality/allowed_space.h"
#include "simplify/legality/fixed_list.h"
#include "simplify/legality/local_star.h"
#include "simplify/mesh/fusion_mesh.h"
#include "simplify/mesh/two_vectors.h"

namespace qtet {

/// The solid gains slope . d + change of volume if the prey goes to d, seen from its first vertex.
struct VolumeChange {
  Vector3 slope{};
  double change = 0;
  double area = 0;            ///< of the star's boundary as it is
  std::size_t triangles = 0;  ///< of it
};

class BoundaryEnvelope {
 public:
  /// FusionLimits::normalCosine.
  BoundaryEnvelope(const FusionMesh& mesh, double normalCosine)
      : mesh_(mesh), normalCosine_(normalCosine) {}

  /// Collects the triangles. REQUIRES: the stars of the prey's vertices have kMaxStarCells cells at
  /// most, all together.
  void gather(const Prey& prey);

  /// p lies on the inner side of (or on) every triangle.
  [[nodiscard]] bool holds(const LatticePoint& p) const;
  /// Moves p onto the planes of the triangles that it lies outside of, one after the other, until
  /// its lattice point is inside.
  [[nodiscard]] bool project(Vector3 p, LatticePoint& inside) const;
  /// Whether with the prey at p the solid gains nothing that lies further outside the original one
  /// than allowed. It presumes that nothing of it does yet.
  [[nodiscard]] bool staysNear(const AllowedSpace& allowed, const LatticePoint& p,
                               DistanceCells& known) const;
  /// REQUIRES: gather.
  [[nodiscard]] VolumeChange volumeChange() const;
  /// Whether with the prey at p a triangle turns further than it may.
  [[nodiscard]] bool turnsTooFar(const LatticePoint& p) const;

 private:
  using Lanes = decltype(Pair{} > Pair{});  // all bits or none of each of two
  struct Face {
    CellId ghost;
    bool stays;           // one of its vertices is prey
    std::uint8_t moving;  // of a face that stays: which
  };
  // The planes of two faces, relative to the first prey vertex. Where there is no second one,
  // nothing is beyond it.
  struct Planes {
    TwoVectors normal;
    Pair height, inverseLength;
    // 0, or -infinity of a sliver whose plane doubles do not know. So whatever lies outside of it
    // lies outside of no other face further.
    Pair allowed;
  };
  // A point as two faces at a time ask for it.
  struct Probe {
    LatticePoint point;
    TwoVectors twice;  // relative to the first prey vertex
    double error;      // of its heights above the planes, times the normals' lengths
  };

  template <std::uint32_t k>
  void addFaces(const Prey& prey);
  void addFace(const Face& face, const Vector3& from);
  [[nodiscard]] std::span<const Planes> planes() const {
    return std::span(planes_).first((faces_.size() + 1) / 2);
  }
  [[nodiscard]] Probe probeOf(const LatticePoint& p) const;
  [[nodiscard]] static Pair heightsOf(const Planes& planes, const Probe& probe);
  [[nodiscard]] static Pair beyond(const Planes& planes, const Probe& probe,
                                   const TwoVectors& past);
  [[nodiscard]] Lanes outsideOf(std::size_t i, const Probe& probe) const;
  [[nodiscard]] bool isOutside(const Face& face, double side, const Probe& probe) const;
  [[nodiscard]] std::optional<std::size_t> farthestFace(const Probe& probe,
                                                        const Vector3& past) const;
  [[nodiscard]] Vector3 wayBack(std::size_t face, const Probe& probe, const Vector3& past,
                                bool keepsDistance) const;
  [[nodiscard]] bool turnsTooFar(const Face& face, const LatticePoint& p) const;

  const FusionMesh& mesh_;
  double normalCosine_;
  FixedList<Face, kMaxStarCells> faces_;
  std::array<Planes, kMaxStarCells / 2> planes_;  // of faces_
  Vector3 origin_{};                              // the first prey vertex
  double reach_ = 0;                              // the largest coordinate of the faces
};

}  // namespace qtet
