#include "simplify/clean/mend_faces.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <iterator>
#include <optional>
#include <span>
#include <unordered_map>

#include "codec/mesh/boundary.h"
#include "simplify/mesh/cell_faces.h"
#include "simplify/mesh/vector3.h"
#include "simplify/mesh/volume_sign.h"

namespace qtet {
namespace {

using Edge = std::array<VertexId, 2>;
using Quad = std::array<VertexId, 4>;  ///< ascending

/// Four points count as one quadrilateral where six times their volume is below this part of the
/// product of their three longest extents.
constexpr double kFlatQuad = 0.1;

/// The boundary without cells that welding has collapsed.
std::vector<Triangle> boundaryOfSound(const std::vector<Tetrahedron>& cells) {
  if (std::ranges::none_of(cells, repeatsAVertex)) return boundaryOf(cells);
  std::vector<Tetrahedron> sound;
  std::ranges::remove_copy_if(cells, std::back_inserter(sound), repeatsAVertex);
  return boundaryOf(sound);
}

/// The boundary's triangles, looked up by their vertices and by their edges.
class Sides {
 public:
  explicit Sides(std::vector<Triangle> boundary) : triangles_(std::move(boundary)) {
    for (Triangle& t : triangles_) std::ranges::sort(t);
    std::ranges::sort(triangles_);
    edges_.reserve(3 * triangles_.size());
    for (const auto& [a, b, c] : triangles_) {
      edges_.push_back({{a, b}, c});
      edges_.push_back({{a, c}, b});
      edges_.push_back({{b, c}, a});
    }
    std::ranges::sort(edges_, {}, [](const Opposite& o) { return std::pair(o.edge, o.vertex); });
  }

  struct Opposite {
    Edge edge;        ///< ascending
    VertexId vertex;  ///< the triangle's third
  };
  [[nodiscard]] const std::vector<Triangle>& triangles() const { return triangles_; }
  [[nodiscard]] bool has(const Quad& quad) const {
    for (std::size_t left = 0; left < 4; ++left) {
      Triangle t{};
      std::ranges::copy_if(quad, t.begin(), [&](VertexId v) { return v != quad[left]; });
      if (!std::ranges::binary_search(triangles_, t)) return false;
    }
    return true;
  }
  [[nodiscard]] std::span<const Opposite> at(const Edge& edge) const {
    const auto range = std::ranges::equal_range(edges_, edge, {}, &Opposite::edge);
    return {range.begin(), range.end()};
  }

 private:
  std::vector<Triangle> triangles_;  ///< ascending in themselves and among each other
  std::vector<Opposite> edges_;
};

/// The sets of four vertices all of whose four triangles are boundary. Each triangle looks round
/// the edge of the fewest triangles, so that an edge of many costs no more than it has.
std::vector<Quad> closedQuads(const std::vector<Triangle>& boundary) {
  const Sides sides(boundary);
  std::vector<Quad> closed;
  for (const auto& [a, b, c] : sides.triangles()) {
    const std::array round{sides.at({a, b}), sides.at({a, c}), sides.at({b, c})};
    for (const auto& [edge, vertex] :
         *std::ranges::min_element(round, {}, [](const auto& some) { return some.size(); })) {
      Quad quad{a, b, c, vertex};
      if (vertex == a || vertex == b || vertex == c) continue;
      std::ranges::sort(quad);
      if (sides.has(quad)) closed.push_back(quad);
    }
  }
  std::ranges::sort(closed);
  closed.erase(std::unique(closed.begin(), closed.end()), closed.end());
  return closed;
}

double lengthOf(const TetMesh& mesh, VertexId a, VertexId b) {
  const Vector3 d = mesh.points[b] - mesh.points[a];
  return std::sqrt(dot(d, d));
}

/// The quadrilateral's diagonals, a-c and b-d: of a flat one they are longer together than either
/// pair of opposite sides. Nothing: a real cavity.
std::optional<std::array<Edge, 2>> diagonalsOf(const TetMesh& mesh, const Quad& q) {
  constexpr std::array<std::array<std::size_t, 4>, 3> kPairs{
      {{0, 1, 2, 3}, {0, 2, 1, 3}, {0, 3, 1, 2}}};
  double longest = -1, product = 1;
  std::array<Edge, 2> out{};
  for (const auto& p : kPairs) {
    const double first = lengthOf(mesh, q[p[0]], q[p[1]]),
                 second = lengthOf(mesh, q[p[2]], q[p[3]]);
    product *= std::max(first, second);
    if (first + second <= longest) continue;
    longest = first + second;
    out = {Edge{q[p[0]], q[p[1]]}, Edge{q[p[2]], q[p[3]]}};
  }
  const double volume6 = std::abs(
      roundedVolume6(mesh.points[q[0]], mesh.points[q[1]], mesh.points[q[2]], mesh.points[q[3]]));
  if (volume6 > kFlatQuad * product) return std::nullopt;
  return out;
}

class Mender {
 public:
  Mender(TetMesh& mesh, const std::vector<Quad>& quads) : mesh_(mesh) {
    for (const Quad& quad : quads) {
      for (const VertexId v : quad) cellsOf_[v];
    }
    for (CellId cell = 0; cell < mesh.tetrahedra.size(); ++cell) enter(cell);
  }

  /// Makes the triangles at diagonal `from` those at diagonal `to`, on the side whose tetrahedra
  /// stand round `from`.
  bool flip(const Edge& from, const Edge& to) {
    if (!findPath(from, to)) return false;
    for (std::size_t apex = 0; apex < path_.size(); ++apex) {
      if (!triangulate(from, apex)) continue;
      replace(from);
      return true;
    }
    return false;
  }

  [[nodiscard]] const std::vector<CellId>& parents() const { return parents_; }

 private:
  void enter(CellId cell) {
    if (repeatsAVertex(mesh_.tetrahedra[cell])) return;
    for (const VertexId v : mesh_.tetrahedra[cell]) {
      if (const auto at = cellsOf_.find(v); at != cellsOf_.end()) at->second.push_back(cell);
    }
  }
  void leave(CellId cell) {
    for (const VertexId v : mesh_.tetrahedra[cell]) {
      if (const auto at = cellsOf_.find(v); at != cellsOf_.end()) std::erase(at->second, cell);
    }
  }

  /// The tetrahedra round `from`, as a path of their other vertices from one end of `to` to the
  /// other.
  bool findPath(const Edge& from, const Edge& to) {
    round_.clear();
    for (const CellId cell : cellsOf_.at(from[0])) {
      if (std::ranges::find(mesh_.tetrahedra[cell], from[1]) != mesh_.tetrahedra[cell].end())
        round_.push_back(cell);
    }
    assert(from[0] != from[1] && to[0] != to[1]);
    std::vector<CellId> left = round_;
    round_.clear();
    path_ = {to[0]};
    while (path_.back() != to[1]) {
      const auto at = std::ranges::find_if(
          left, [&](CellId cell) { return otherOf(cell, from, path_.back()) != kGhost; });
      if (at == left.end()) return false;
      path_.push_back(otherOf(*at, from, path_.back()));
      round_.push_back(*at);
      left.erase(at);
    }
    return path_.size() >= 3;
  }

  /// The fourth vertex of a cell that has `edge` and `v`; kGhost: it has not.
  [[nodiscard]] VertexId otherOf(CellId cell, const Edge& edge, VertexId v) const {
    VertexId other = kGhost;
    bool found = false;
    for (const VertexId w : mesh_.tetrahedra[cell]) {
      if (w == v)
        found = true;
      else if (w != edge[0] && w != edge[1])
        other = w;
    }
    return found ? other : kGhost;
  }

  [[nodiscard]] int sign(VertexId a, VertexId b, VertexId c, VertexId d) const {
    return volumeSign(mesh_.points[a], mesh_.points[b], mesh_.points[c], mesh_.points[d]);
  }

  /// Cuts the path's polygon as a fan from path_[apex]; false where a tetrahedron would be flat or
  /// inside out.
  bool triangulate(const Edge& from, std::size_t apex) {
    assert(path_.size() >= 3 && apex < path_.size() && round_.size() + 1 == path_.size());
    const std::size_t n = path_.size();
    const int sense = sign(from[0], from[1], path_[0], path_[1]);
    for (std::size_t k = 0; k + 1 < n; ++k) {
      if (sense == 0 || sign(from[0], from[1], path_[k], path_[k + 1]) != sense) return false;
    }
    triangles_.clear();
    for (std::size_t k = 1; k + 1 < n; ++k) {
      std::array<std::size_t, 3> corner{apex, (apex + k) % n, (apex + k + 1) % n};
      std::ranges::sort(corner);
      const VertexId p = path_[corner[0]], q = path_[corner[1]], r = path_[corner[2]];
      if (sign(from[0], p, q, r) != sense || sign(from[1], p, q, r) != -sense) return false;
      // Where one of its sides is a step of the path, it comes from that step's tetrahedron.
      triangles_.push_back({{p, q, r}, corner[1] == corner[0] + 1 ? corner[0] : corner[1]});
    }
    return true;
  }

  void replace(const Edge& from) {
    assert(triangles_.size() + 2 == path_.size());
    std::vector<CellId> origin;
    for (const CellId cell : round_) origin.push_back(parentOf(cell));
    for (const CellId cell : round_) leave(cell);
    std::size_t used = 0;
    for (const Fan& fan : triangles_) {
      const Triangle& t = fan.triangle;
      const bool positive = sign(from[0], t[0], t[1], t[2]) > 0;
      for (const bool first : {true, false}) {
        const bool keep = positive == first;
        const Tetrahedron cell{first ? from[0] : from[1], t[0], keep ? t[1] : t[2],
                               keep ? t[2] : t[1]};
        assert(fan.step < origin.size());
        place(cell, origin[fan.step], used);
      }
    }
    assert(used == round_.size());
  }

  void place(const Tetrahedron& cell, CellId parent, std::size_t& used) {
    const bool reuses = used < round_.size();
    const CellId at = reuses ? round_[used++] : static_cast<CellId>(mesh_.tetrahedra.size());
    if (!reuses) mesh_.tetrahedra.emplace_back();
    mesh_.tetrahedra[at] = cell;
    while (parents_.size() < mesh_.tetrahedra.size())
      parents_.push_back(static_cast<CellId>(parents_.size()));
    parents_[at] = parent;
    enter(at);
  }

  [[nodiscard]] CellId parentOf(CellId cell) const {
    return cell < parents_.size() ? parents_[cell] : cell;
  }

  struct Fan {
    Triangle triangle;
    std::size_t step;  ///< of the path, and so of round_
  };

  TetMesh& mesh_;
  std::unordered_map<VertexId, std::vector<CellId>> cellsOf_;
  std::vector<CellId> round_, parents_;
  std::vector<VertexId> path_;
  std::vector<Fan> triangles_;
};

void inherit(TetMesh& mesh, const std::vector<CellId>& parents) {
  for (MeshField& field : mesh.fields) {
    if (!isCellField(field)) continue;
    assert(parents.size() == mesh.tetrahedra.size());
    const std::vector<double> before = field.values;
    field.values.resize(parents.size() * field.components);
    for (std::size_t i = 0; i < parents.size(); ++i)
      std::copy_n(before.data() + parents[i] * field.components, field.components,
                  field.values.data() + i * field.components);
  }
}

}  // namespace

MendReport mendCrossedFaces(TetMesh& mesh) {
  MendReport report;
  const std::vector<Quad> quads = closedQuads(boundaryOfSound(mesh.tetrahedra));
  if (quads.empty()) return report;
  Mender mender(mesh, quads);
  for (const Quad& quad : quads) {
    const auto diagonals = diagonalsOf(mesh, quad);
    if (!diagonals) continue;
    const auto& [one, other] = *diagonals;
    mender.flip(one, other) || mender.flip(other, one) ? ++report.mended : ++report.left;
  }
  if (report.mended > 0) inherit(mesh, mender.parents());
  return report;
}

}  // namespace qtet
