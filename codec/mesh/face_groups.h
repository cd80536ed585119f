// The cells round each face of a tetrahedral mesh, in linear time and the same order everywhere.
#pragma once

#include <atomic>
#include <compare>
#include <cstdint>
#include <span>
#include <vector>

#include "codec/mesh/mesh.h"

namespace qtet {

/// One side of a face: 4 * cell + opposite corner.
using FaceSide = std::uint64_t;

[[nodiscard]] inline CellId cellOf(FaceSide side) { return static_cast<CellId>(side / 4); }
[[nodiscard]] inline int oppositeCornerOf(FaceSide side) { return static_cast<int>(side % 4); }

/// Every face's sides, sorted so that the sides of one face follow one another, the lower cell
/// first.
class FaceGroups {
 public:
  /// Memory grows with the largest vertex id, so ids from outside are compared with the vertex
  /// count before. Once `stopped` is true it gives up, and there are no groups. REQUIRES: no kGhost
  /// among the vertices, four different vertices a cell.
  explicit FaceGroups(std::span<const Tetrahedron> tetrahedra,
                      const std::atomic<bool>* stopped = nullptr);

  /// Calls visit(std::span<const FaceSide>) once a face: one side on the boundary, two inside, more
  /// where the mesh is not a solid.
  template <class Visit>
  void forEach(Visit visit) const {
    std::vector<FaceSide> sides;
    std::size_t first = 0;
    for (const std::uint64_t end : ends_) {
      while (first < end) {
        sides.clear();
        const std::uint64_t rest = faces_[first].rest;
        for (; first < end && faces_[first].rest == rest; ++first)
          sides.push_back(faces_[first].side);
        visit(std::span<const FaceSide>(sides));
      }
    }
  }

 private:
  struct Face {
    std::uint64_t rest;  // its middle vertex and, in the low half, its largest one
    FaceSide side;

    friend auto operator<=>(const Face&, const Face&) = default;
  };

  std::vector<Face> faces_;          // by smallest vertex
  std::vector<std::uint64_t> ends_;  // the faces of smallest vertex v end before ends_[v]
};

}  // namespace qtet
