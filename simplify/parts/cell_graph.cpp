#include "simplify/parts/cell_graph.h"

#include <cassert>

#include "codec/mesh/boundary.h"
#include "codec/mesh/face_groups.h"
#include "simplify/mesh/fusion_mesh.h"

namespace qtet {
namespace {

/// Any face costs 1 to cut, and so much more for each of its vertices that could not be fused the
/// last time.
constexpr std::int32_t kOldVertex = 3;

}  // namespace

CellGraph cellGraphOf(const FusionMesh& mesh, std::span<const CellId> cells,
                      std::span<const std::uint8_t> old) {
  CellGraph out;
  std::vector<Tetrahedron> tetrahedra;
  tetrahedra.reserve(cells.size());
  for (const CellId c : cells) tetrahedra.push_back(mesh.cell(c));
  struct Face {
    CellId one, other;
    std::int32_t weight;
  };
  std::vector<Face> faces;
  faces.reserve(2 * tetrahedra.size());
  out.begins.assign(tetrahedra.size() + 1, 0);
  FaceGroups(tetrahedra).forEach([&](std::span<const FaceSide> sides) {
    if (sides.size() != 2) return;
    assert(cellOf(sides[0]) != cellOf(sides[1]));
    std::int32_t weight = 1;
    for (const VertexId v : cellFace(tetrahedra[cellOf(sides[0])], oppositeCornerOf(sides[0])))
      if (v < old.size() && old[v]) weight += kOldVertex;
    faces.push_back({cellOf(sides[0]), cellOf(sides[1]), weight});
    ++out.begins[cellOf(sides[0]) + 1], ++out.begins[cellOf(sides[1]) + 1];
  });
  for (std::size_t i = 1; i < out.begins.size(); ++i) out.begins[i] += out.begins[i - 1];
  assert(static_cast<std::size_t>(out.begins.back()) == 2 * faces.size());
  out.beside.resize(2 * faces.size()), out.weights.resize(2 * faces.size());
  std::vector<std::int32_t> next(out.begins.begin(), out.begins.end() - 1);
  const auto put = [&](CellId from, CellId to, std::int32_t weight) {
    assert(next[from] < out.begins[from + std::size_t{1}]);
    const auto at = static_cast<std::size_t>(next[from]++);
    out.beside[at] = static_cast<std::int32_t>(to), out.weights[at] = weight;
  };
  for (const Face& face : faces)
    put(face.one, face.other, face.weight), put(face.other, face.one, face.weight);
  return out;
}

}  // namespace qtet
