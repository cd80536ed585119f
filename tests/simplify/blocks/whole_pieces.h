// A mesh at hand as the pieces that the reduction takes.
#pragma once

#include <algorithm>
#include <map>
#include <utility>
#include <vector>

#include "codec/mesh/boundary.h"
#include "simplify/blocks/reduce_mesh.h"

namespace qtet::testing {

class WholePieces final : public LatticePieces {
 public:
  /// Gives `count` pieces, or fewer. `missing` may be empty.
  WholePieces(const LatticeMesh& mesh, std::vector<std::vector<std::uint8_t>> missing,
              std::size_t count = 1)
      : mesh_(mesh), missing_(std::move(missing)), count_(count) {
    missing_.resize(mesh.fields.size());
  }

  [[nodiscard]] const Lattice& lattice() const override { return mesh_.lattice; }
  [[nodiscard]] const std::vector<FieldInfo>& fields() const override { return mesh_.fields; }
  [[nodiscard]] std::uint64_t tetrahedra() const override { return mesh_.tetrahedra.size(); }
  [[nodiscard]] std::uint64_t vertices() const override { return mesh_.points.size(); }
  [[nodiscard]] std::uint64_t triangles() const override { return mesh_.boundary.size(); }
  [[nodiscard]] Status forEach(const TakePiece& take) override {
    const std::size_t cells = mesh_.tetrahedra.size(), step = (cells + count_ - 1) / count_;
    const std::vector<Triangle> boundary = boundaryOf(mesh_.tetrahedra);
    auto face = boundary.begin();
    std::uint32_t number = 0;
    for (std::size_t begin = 0; begin < cells; begin += step, ++number) {
      GivenPiece out;
      out.number = number;
      out.isLast = begin + step >= cells;
      std::map<VertexId, VertexId> numbers;
      for (std::size_t c = begin; c < std::min(begin + step, cells); ++c)
        for (const VertexId v : mesh_.tetrahedra[c]) numbers[v];
      VertexId next = 0;
      for (auto& [v, own] : numbers) {
        own = next++;
        out.piece.vertices.push_back(v);
        out.piece.points.push_back(mesh_.points[v]);
        if (count_ > 1) out.shared.push_back(v);  // they may be
      }
      takeValues(numbers, begin, std::min(begin + step, cells), out.piece);
      for (std::size_t c = begin; c < std::min(begin + step, cells); ++c) {
        Tetrahedron cell = mesh_.tetrahedra[c];
        for (int corner = 0; corner < 4; ++corner)
          if (face != boundary.end() && cellFace(cell, corner) == *face) {
            Triangle t = *face++;
            for (VertexId& v : t) v = numbers[v];
            out.piece.boundary.push_back({t, static_cast<CellId>(c - begin)});
          }
        for (VertexId& v : cell) v = numbers[v];
        out.piece.tetrahedra.push_back(cell);
      }
      if (Status s = take(std::move(out)); !s) return s;
    }
    return {};
  }

 private:
  void takeValues(const std::map<VertexId, VertexId>& vertices, std::size_t begin, std::size_t end,
                  MeshPiece& out) const {
    out.values.resize(mesh_.fields.size());
    out.missing.resize(mesh_.fields.size());
    for (std::size_t f = 0; f < mesh_.fields.size(); ++f) {
      const std::size_t n = mesh_.fields[f].components;
      const auto take = [&](std::size_t i) {
        for (std::size_t c = 0; c < n; ++c) {
          out.values[f].push_back(mesh_.values[f][i * n + c]);
          if (!missing_[f].empty()) out.missing[f].push_back(missing_[f][i * n + c]);
        }
      };
      if (isCellField(mesh_.fields[f]))
        for (std::size_t c = begin; c < end; ++c) take(c);
      else
        for (const auto& [v, own] : vertices) take(v);
    }
  }

  const LatticeMesh& mesh_;
  std::vector<std::vector<std::uint8_t>> missing_;
  std::size_t count_;
};

inline Result<ReducedMesh> reduceWhole(const LatticeMesh& mesh,
                                       std::vector<std::vector<std::uint8_t>> missing,
                                       const FusionOptions& options, const ReduceOptions& reduce,
                                       std::size_t count = 1) {
  WholePieces pieces(mesh, std::move(missing), count);
  const Result<OriginalFigures> figures = OriginalFigures::of(pieces);
  if (!figures) return std::unexpected(figures.error());
  return reduceMesh(pieces, *figures, options, reduce);
}

}  // namespace qtet::testing
