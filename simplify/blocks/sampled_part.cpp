#include "simplify/blocks/sampled_part.h"

#include <algorithm>
#include <numeric>

namespace qtet {

void SampledPart::addVertex(const LatticeMesh& piece, std::span<const WholeVertex> names,
                            VertexId v) {
  vertices_.push_back(names[v]);
  mesh_.points.push_back(piece.points[v]);
  mesh_.values.resize(fields_.size());
  for (std::size_t f = 0; f < fields_.size(); ++f) {
    if (isCellField(fields_[f])) continue;
    const std::size_t n = fields_[f].components;
    for (std::size_t c = 0; c < n; ++c) mesh_.values[f].push_back(piece.values[f][v * n + c]);
  }
}

void SampledPart::addCell(const LatticeMesh& piece, std::span<const WholeVertex> names,
                          const Tetrahedron& cell) {
  const auto first = static_cast<VertexId>(vertices_.size());
  for (const VertexId v : cell) addVertex(piece, names, v);
  mesh_.tetrahedra.push_back({first, first + 1, first + 2, first + 3});
}

void SampledPart::addTriangle(const LatticeMesh& piece, std::span<const WholeVertex> names,
                              const Triangle& triangle) {
  const auto first = static_cast<VertexId>(vertices_.size());
  for (const VertexId v : triangle) addVertex(piece, names, v);
  mesh_.boundary.push_back({first, first + 1, first + 2});
}

LatticeMesh SampledPart::take(const Lattice& lattice) {
  std::vector<VertexId> order(vertices_.size()), numbers(vertices_.size());
  std::iota(order.begin(), order.end(), VertexId{0});
  std::ranges::sort(order, [&](VertexId a, VertexId b) {
    return std::pair(vertices_[a], a) < std::pair(vertices_[b], b);
  });
  LatticeMesh out;
  out.lattice = lattice;
  out.fields = fields_;
  out.values.resize(fields_.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    const VertexId v = order[i];
    if (i == 0 || vertices_[v] != vertices_[order[i - 1]]) {
      out.points.push_back(mesh_.points[v]);
      for (std::size_t f = 0; f < fields_.size(); ++f) {
        if (isCellField(fields_[f])) continue;
        const std::size_t n = fields_[f].components;
        for (std::size_t c = 0; c < n; ++c) out.values[f].push_back(mesh_.values[f][v * n + c]);
      }
    }
    numbers[v] = static_cast<VertexId>(out.points.size() - 1);
  }
  out.tetrahedra = std::move(mesh_.tetrahedra);
  for (Tetrahedron& cell : out.tetrahedra)
    for (VertexId& v : cell) v = numbers[v];
  out.boundary = std::move(mesh_.boundary);
  for (Triangle& triangle : out.boundary)
    for (VertexId& v : triangle) v = numbers[v];
  vertices_.clear();
  mesh_ = {};
  return out;
}

}  // namespace qtet
