#include "simplify/log/match_mesh.h"

#include <algorithm>
#include <numeric>
#include <string>

namespace qtet {
namespace {

Tetrahedron sortedCell(Tetrahedron cell) {
  std::ranges::sort(cell);
  return cell;
}

std::string textOf(const Tetrahedron& cell) {
  std::string out;
  for (const VertexId v : cell) out += (out.empty() ? "" : ", ") + std::to_string(v);
  return out;
}

class Matcher {
 public:
  Matcher(const LatticeMesh& mesh, std::span<const LatticePoint> logPoints,
          std::span<const Tetrahedron> logCells)
      : mesh_(mesh), logPoints_(logPoints), logCells_(logCells) {}

  Result<MeshMatch> run() {
    if (mesh_.points.size() != logPoints_.size() || mesh_.tetrahedra.size() != logCells_.size())
      return fail(ErrorCode::kBadValue, "the mesh has " + std::to_string(mesh_.points.size()) +
                                            " points and " +
                                            std::to_string(mesh_.tetrahedra.size()) +
                                            " cells, the log " + std::to_string(logPoints_.size()) +
                                            " and " + std::to_string(logCells_.size()) + kOther);
    out_.points.assign(mesh_.points.size(), kGhost);
    out_.tetrahedra.assign(mesh_.tetrahedra.size(), kGhost);
    if (Status s = placePoints(); !s) return std::unexpected(s.error());
    if (Status s = matchCells(true); !s) return std::unexpected(s.error());
    if (Status s = checkPoints(); !s) return std::unexpected(s.error());
    if (Status s = matchCells(false); !s) return std::unexpected(s.error());
    return std::move(out_);
  }

 private:
  static constexpr const char* kOther =
      "; the fields must come from the mesh that the log was made from";

  // Gives every place that the log uses a number, and both meshes' points the number of theirs.
  Status placePoints() {
    std::vector<LatticePoint> places(logPoints_.begin(), logPoints_.end());
    std::ranges::sort(places);
    places.erase(std::ranges::unique(places).begin(), places.end());
    const auto placeOf = [&](const LatticePoint& p) {
      return static_cast<VertexId>(std::ranges::lower_bound(places, p) - places.begin());
    };
    std::vector<VertexId> occupant(places.size(), kGhost);
    std::vector<std::uint8_t> shared(places.size(), 0);
    for (VertexId v = 0; v < logPoints_.size(); ++v) {
      const VertexId place = placeOf(logPoints_[v]);
      shared[place] |= occupant[place] != kGhost;
      occupant[place] = v;
      logPlace_.push_back(place);
    }
    for (VertexId v = 0; v < mesh_.points.size(); ++v) {
      const LatticePoint& p = mesh_.points[v];
      const VertexId place = placeOf(p);
      if (place == places.size() || places[place] != p)
        return fail(ErrorCode::kBadValue,
                    "point " + std::to_string(v) + " of the cleaned mesh, at lattice point (" +
                        std::to_string(p[0]) + ", " + std::to_string(p[1]) + ", " +
                        std::to_string(p[2]) + "), is no point of the log" + kOther);
      if (!shared[place]) out_.points[v] = occupant[place];
      meshPlace_.push_back(place);
    }
    return {};
  }

  // Matches cells by the places of their vertices, where these say enough, to tell apart points
  // that share a place. At last it matches them by the points themselves.
  Status matchCells(bool byPlace) {
    struct Keyed {
      Tetrahedron key{};
      CellId cell = 0;
      auto operator<=>(const Keyed&) const = default;
    };
    const auto keyed = [](std::span<const Tetrahedron> cells, const auto& name) {
      std::vector<Keyed> out;
      for (CellId t = 0; t < cells.size(); ++t) {
        Tetrahedron key{};
        for (std::size_t i = 0; i < 4; ++i) key[i] = name(cells[t][i]);
        out.push_back({sortedCell(key), t});
      }
      std::ranges::sort(out);
      return out;
    };
    const std::vector<Keyed> mine = keyed(
        mesh_.tetrahedra, [&](VertexId v) { return byPlace ? meshPlace_[v] : out_.points[v]; });
    const std::vector<Keyed> theirs =
        keyed(logCells_, [&](VertexId v) { return byPlace ? logPlace_[v] : v; });
    for (std::size_t i = 0; i < mine.size(); ++i) {
      if (mine[i].key != theirs[i].key) {
        // The lower key of the two is the one that the other side lacks; an equal one may stand
        // before it.
        const CellId cell =
            mine[i].key < theirs[i].key ? mine[i].cell : mine[i > 0 ? i - 1 : i].cell;
        return fail(ErrorCode::kBadValue,
                    "cell " + std::to_string(cell) + " of the cleaned mesh, of points " +
                        textOf(mesh_.tetrahedra[cell]) +
                        ", or one that shares points with it, is no cell of the log" + kOther);
      }
      if (!byPlace) {
        out_.tetrahedra[mine[i].cell] = theirs[i].cell;
        continue;
      }
      const bool twin = (i > 0 && mine[i - 1].key == mine[i].key) ||
                        (i + 1 < mine.size() && mine[i + 1].key == mine[i].key);
      if (twin) continue;
      if (Status s = matchVertices(mine[i].cell, theirs[i].cell); !s) return s;
    }
    return {};
  }

  // Matches the vertices of two cells that are the same by their places.
  Status matchVertices(CellId mine, CellId theirs) {
    for (const VertexId v : mesh_.tetrahedra[mine]) {
      VertexId found = kGhost;
      int count = 0;
      for (const VertexId u : logCells_[theirs])
        if (logPlace_[u] == meshPlace_[v]) found = u, ++count;
      if (count != 1) continue;
      if (out_.points[v] != kGhost && out_.points[v] != found)
        return fail(ErrorCode::kBadValue, "point " + std::to_string(v) +
                                              " of the cleaned mesh is two points of the log, " +
                                              std::to_string(out_.points[v]) + " and " +
                                              std::to_string(found) + kOther);
      out_.points[v] = found;
    }
    return {};
  }

  Status checkPoints() const {
    std::vector<std::uint8_t> taken(logPoints_.size(), 0);
    for (VertexId v = 0; v < out_.points.size(); ++v) {
      if (out_.points[v] == kGhost)
        return fail(ErrorCode::kBadValue, "point " + std::to_string(v) +
                                              " of the cleaned mesh shares its place with another "
                                              "one, and no cell tells the two apart");
      if (std::exchange(taken[out_.points[v]], std::uint8_t{1}) != 0)
        return fail(ErrorCode::kBadValue,
                    "point " + std::to_string(v) +
                        " of the cleaned mesh and one before it are the same point of the log" +
                        kOther);
    }
    return {};
  }

  const LatticeMesh& mesh_;
  std::span<const LatticePoint> logPoints_;
  std::span<const Tetrahedron> logCells_;
  std::vector<VertexId> logPlace_, meshPlace_;
  MeshMatch out_;
};

}  // namespace

Result<MeshMatch> matchMesh(const LatticeMesh& mesh, std::span<const LatticePoint> logPoints,
                            std::span<const Tetrahedron> logCells) {
  return Matcher(mesh, logPoints, logCells).run();
}

}  // namespace qtet
