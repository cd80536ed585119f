// Whether the link of a vertex is a sphere, asked of every vertex of a mesh: what codec/mesh/link.h
// would say, in a third of the time.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "codec/mesh/link.h"
#include "codec/mesh/mesh.h"

namespace qtet {

class SphereCheck {
 public:
  /// `vertices`: how many there are; ids are below, or kGhost.
  explicit SphereCheck(std::size_t vertices) : numbers_(vertices + 1) {}

  /// The triangles that `star`'s cells have opposite v form one sphere: every edge is met once in
  /// each direction, all hang together by edges, the Euler characteristic is 2. REQUIRES: v is in
  /// each cell of the star, none names a vertex twice, and no two have the same vertices.
  [[nodiscard]] bool isLinkSphere(VertexId v, std::span<const CellId> star,
                                  std::span<const Tetrahedron> cells);

 private:
  using Small = std::uint8_t;  // a vertex of the link
  using Mask = std::uint64_t;  // bit i: vertex i
  static constexpr std::size_t kMax = 64;

  static constexpr std::uint32_t kMaxNumbers = kMax + 3;  // that one question gives away

  [[nodiscard]] bool isClosed(std::uint32_t vertices, std::size_t triangles);
  [[nodiscard]] bool isSurelyConnected(std::uint32_t vertices) const;
  [[nodiscard]] bool isConnected(std::size_t triangles);
  [[nodiscard]] bool askLink(VertexId v, std::span<const CellId> star,
                             std::span<const Tetrahedron> cells);

  // by vertex, the ghost's the last: base_ and its number in the last link that it was in
  std::vector<std::uint32_t> numbers_;
  std::uint32_t base_ = 0;
  // By vertex of the link: the ends of the edges from it, the starts of those to it, and which of
  // the former were walked.
  std::array<Mask, kMax> to_{}, from_{}, walked_{};
  Mask simple_ = 0;                         // vertices with too few edges for two fans
  std::array<Small, kMax * kMax> third_{};  // by edge, 64 a + b: the triangle's other vertex
  // edges whose triangles are to come; a sphere of n vertices has 2 n - 4 triangles, each adds two
  std::array<std::array<Small, 2>, 4 * kMax> walk_{};
  Link link_;  // for what is larger
};

}  // namespace qtet
