#include "simplify/pieces/cut_pieces.h"

#include <algorithm>
#include <cassert>
#include <span>

namespace qtet {
InputPiece cutOut(const TetMesh& mesh, std::size_t begin, std::size_t end) {
  assert(begin <= end && end <= mesh.tetrahedra.size());
  InputPiece out;
  out.firstCell = begin;
  out.mesh.pointType = mesh.pointType;
  const auto cells = std::span(mesh.tetrahedra).subspan(begin, end - begin);
  for (const Tetrahedron& cell : cells)
    out.vertices.insert(out.vertices.end(), cell.begin(), cell.end());
  std::ranges::sort(out.vertices);
  const auto repeated = std::ranges::unique(out.vertices);
  out.vertices.erase(repeated.begin(), repeated.end());
  for (const WholeVertex v : out.vertices) out.mesh.points.push_back(mesh.points[v]);
  for (Tetrahedron cell : cells) {
    for (VertexId& v : cell)
      v = static_cast<VertexId>(std::ranges::lower_bound(out.vertices, WholeVertex{v}) -
                                out.vertices.begin());
    out.mesh.tetrahedra.push_back(cell);
  }
  for (const MeshField& field : mesh.fields) {
    MeshField& own = out.mesh.fields.emplace_back(withoutValues(field));
    const std::size_t n = field.components;
    const auto take = [&](std::size_t i) {
      const auto first = field.values.begin() + static_cast<std::ptrdiff_t>(i * n);
      own.values.insert(own.values.end(), first, first + static_cast<std::ptrdiff_t>(n));
    };
    if (isCellField(field))
      for (std::size_t c = begin; c < end; ++c) take(c);
    else
      for (const WholeVertex v : out.vertices) take(v);
  }
  return out;
}

Result<std::optional<InputPiece>> CutPieces::next() {
  const std::size_t begin = nextCell_;
  if (begin == mesh_.tetrahedra.size()) {
    mesh_ = {}, nextCell_ = 0;
    return std::nullopt;
  }
  nextCell_ = std::min(begin + pieceCells_, mesh_.tetrahedra.size());
  return cutOut(mesh_, begin, nextCell_);
}

}  // namespace qtet
