#include "simplify/mesh/cell_faces.h"

#include <algorithm>
#include <string>

#include "codec/mesh/boundary.h"
#include "codec/mesh/face_groups.h"

namespace qtet {
namespace {

VertexId oppositeVertex(std::span<const Tetrahedron> cells, FaceSide side) {
  return cells[cellOf(side)][static_cast<std::size_t>(oppositeCornerOf(side))];
}

bool sameRotation(const Triangle& s, const Triangle& t) {
  const std::size_t at = t[0] == s[0] ? 0 : t[0] == s[1] ? 1 : 2;
  return t[1] == s[(at + 1) % 3];
}

void join(std::span<const Tetrahedron> cells, FaceSide one, FaceSide other,
          std::vector<CellNeighbours>& out) {
  const bool disagree = sameRotation(cellFace(cells[cellOf(one)], oppositeCornerOf(one)),
                                     cellFace(cells[cellOf(other)], oppositeCornerOf(other)));
  const auto set = [&](FaceSide from, FaceSide to) {
    CellNeighbours& neighbours = out[cellOf(from)];
    neighbours.across[static_cast<std::size_t>(oppositeCornerOf(from))] = cellOf(to);
    if (disagree) neighbours.disagrees |= static_cast<std::uint8_t>(1u << oppositeCornerOf(from));
  };
  set(one, other);
  set(other, one);
}

}  // namespace

std::vector<CellId> duplicatesIn(std::span<const Tetrahedron> cells,
                                 const std::atomic<bool>* stopped) {
  std::vector<CellId> duplicates;
  // Cells with the same vertices share all four faces, and only they share a face and the vertex
  // opposite it.
  FaceGroups(cells, stopped).forEach([&](std::span<const FaceSide> sides) {
    for (std::size_t i = 1; i < sides.size(); ++i) {
      const auto isTwin = [&](FaceSide earlier) {
        return oppositeVertex(cells, earlier) == oppositeVertex(cells, sides[i]);
      };
      if (std::any_of(sides.begin(), sides.begin() + static_cast<std::ptrdiff_t>(i), isTwin))
        duplicates.push_back(cellOf(sides[i]));
    }
  });
  std::sort(duplicates.begin(), duplicates.end());
  duplicates.erase(std::unique(duplicates.begin(), duplicates.end()), duplicates.end());
  return duplicates;
}

std::vector<CellId> crowdedFacesIn(std::span<const Tetrahedron> cells) {
  std::vector<CellId> crowded;
  FaceGroups(cells).forEach([&](std::span<const FaceSide> sides) {
    if (sides.size() > 2) crowded.push_back(cellOf(sides[0]));
  });
  std::sort(crowded.begin(), crowded.end());
  return crowded;
}

Result<std::vector<CellNeighbours>> neighboursOf(std::span<const Tetrahedron> cells,
                                                 std::span<const std::uint64_t> names,
                                                 const std::atomic<bool>* stopped) {
  std::vector<CellNeighbours> out(cells.size());
  std::vector<FaceSide> crowded;
  FaceGroups(cells, stopped).forEach([&](std::span<const FaceSide> sides) {
    if (sides.size() == 2) join(cells, sides[0], sides[1], out);
    if (sides.size() > 2 && crowded.empty()) crowded.assign(sides.begin(), sides.end());
  });
  if (crowded.empty()) return out;

  std::string list;
  for (const FaceSide side : crowded)
    list += (list.empty() ? "" : ", ") + std::to_string(names[cellOf(side)]);
  return fail(ErrorCode::kBadInput,
              std::to_string(crowded.size()) + " cells (" + list +
                  ") share one face, so they overlap; at most two can. Remove the superfluous "
                  "ones, or export the parts as separate files");
}

}  // namespace qtet
