#include "simplify/mesh/cell_faces.h"

#include <algorithm>
#include <cassert>

#include "codec/mesh/boundary.h"
#include "codec/mesh/face_groups.h"

namespace qtet {
namespace {

VertexId oppositeVertex(std::span<const Tetrahedron> cells, FaceSide side) {
  return cells[cellOf(side)][static_cast<std::size_t>(oppositeCornerOf(side))];
}

bool sameRotation(const Triangle& s, const Triangle& t) {
  const std::size_t at = t[0] == s[0] ? 0 : t[0] == s[1] ? 1 : 2;
  assert(t[0] == s[at]);
  return t[1] == s[(at + 1) % 3];
}

void join(std::span<const Tetrahedron> cells, FaceSide one, FaceSide other,
          std::vector<CellNeighbours>& out) {
  const bool disagree = sameRotation(cellFace(cells[cellOf(one)], oppositeCornerOf(one)),
                                     cellFace(cells[cellOf(other)], oppositeCornerOf(other)));
  const auto set = [&](FaceSide from, FaceSide to) {
    CellNeighbours& neighbours = out[cellOf(from)];
    assert(neighbours.across[static_cast<std::size_t>(oppositeCornerOf(from))] == kNoCell);
    neighbours.across[static_cast<std::size_t>(oppositeCornerOf(from))] = cellOf(to);
    if (disagree) neighbours.disagrees |= static_cast<std::uint8_t>(1u << oppositeCornerOf(from));
  };
  set(one, other);
  set(other, one);
}

// Cells with the same vertices share all four faces, and only they share a face and the vertex
// opposite it.
void addDuplicates(std::span<const Tetrahedron> cells, std::span<const FaceSide> sides,
                   std::vector<CellId>& duplicates) {
  for (std::size_t i = 1; i < sides.size(); ++i) {
    const VertexId opposite = oppositeVertex(cells, sides[i]);
    if (std::ranges::any_of(sides.first(i), [&](FaceSide earlier) {
          return oppositeVertex(cells, earlier) == opposite;
        }))
      duplicates.push_back(cellOf(sides[i]));
  }
}

}  // namespace

std::vector<Triangle> MatchedFaces::boundaryOf(std::span<const Tetrahedron> cells) const {
  assert(cells.size() == neighbours.size());
  std::vector<Triangle> boundary;
  for (std::size_t cell = 0; cell < cells.size(); ++cell) {
    for (std::size_t i = 0; i < 4; ++i) {
      if (neighbours[cell].across[i] == kNoCell)
        boundary.push_back(cellFace(cells[cell], static_cast<int>(i)));
    }
  }
  return boundary;
}

MatchedFaces matchFaces(std::span<const Tetrahedron> cells, const std::atomic<bool>* stopped) {
  MatchedFaces out;
  out.neighbours.resize(cells.size());
  FaceGroups(cells, stopped).forEach([&](std::span<const FaceSide> sides) {
    if (sides.size() == 1) return;
    addDuplicates(cells, sides, out.duplicates);
    if (sides.size() == 2) {
      join(cells, sides[0], sides[1], out.neighbours);
      return;
    }
    if (out.crowded.empty())
      for (const FaceSide side : sides) out.firstCrowd.push_back(cellOf(side));
    out.crowded.push_back(cellOf(sides[0]));
  });
  std::ranges::sort(out.duplicates);
  out.duplicates.erase(std::unique(out.duplicates.begin(), out.duplicates.end()),
                       out.duplicates.end());
  std::ranges::sort(out.crowded);
  return out;
}

}  // namespace qtet
