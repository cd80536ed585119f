#include "codec/mesh/boundary.h"

#include <cassert>
#include <cstdint>

#include "codec/mesh/face_groups.h"

namespace qtet {

std::vector<Triangle> boundaryOf(std::span<const Tetrahedron> tetrahedra,
                                 const std::atomic<bool>* stopped) {
  // bit i: no other cell has the face opposite corner i
  std::vector<std::uint8_t> open(tetrahedra.size(), 0);
  FaceGroups(tetrahedra, stopped).forEach([&](std::span<const FaceSide> sides) {
    if (sides.size() == 1)
      open[cellOf(sides[0])] |= static_cast<std::uint8_t>(1u << oppositeCornerOf(sides[0]));
  });

  std::vector<Triangle> boundary;
  for (std::size_t cell = 0; cell < tetrahedra.size(); ++cell) {
    for (int i = 0; i < 4; ++i) {
      if (open[cell] & (1u << i)) boundary.push_back(cellFace(tetrahedra[cell], i));
    }
  }
  return boundary;
}

CompactTriangles compactTriangles(std::span<const Triangle> triangles, std::size_t vertexCount) {
  constexpr VertexId kAbsent = 0xFFFFFFFFu;
  CompactTriangles out{{}, {triangles.begin(), triangles.end()}};
  std::vector<VertexId> numbers(vertexCount, kAbsent);
  for (const Triangle& triangle : triangles)
    for (const VertexId v : triangle) {
      assert(v < vertexCount);
      numbers[v] = 0;
    }
  for (VertexId v = 0; v < numbers.size(); ++v) {
    if (numbers[v] == kAbsent) continue;
    numbers[v] = static_cast<VertexId>(out.vertices.size());
    out.vertices.push_back(v);
  }
  for (Triangle& triangle : out.triangles)
    for (VertexId& v : triangle) v = numbers[v];
  return out;
}

}  // namespace qtet
