#include "simplify/read/vtu/structured_cells.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <span>

#include "simplify/read/options/grid_parts.h"
#include "simplify/read/vtu/vtu_numbers.h"

namespace qtet {
namespace {

/// The bit of kGhostTypes of points that are blanked out.
constexpr std::int64_t kHiddenPoint = 2;

using Counts = std::array<std::uint64_t, 3>;

/// Points along each axis.
Counts pointsAlong(const VtuPiece& piece) {
  Counts out{};
  for (std::size_t axis = 0; axis < 3; ++axis)
    out[axis] = static_cast<std::uint64_t>(std::max<std::int64_t>(
        0, std::int64_t{piece.extent[2 * axis + 1]} - piece.extent[2 * axis] + 1));
  return out;
}

/// visit(i, j, k), the first axis changing first.
template <class Visit>
void forEachPlace(const Counts& counts, const Visit& visit) {
  for (std::uint64_t k = 0; k < counts[2]; ++k)
    for (std::uint64_t j = 0; j < counts[1]; ++j)
      for (std::uint64_t i = 0; i < counts[0]; ++i) visit(i, j, k);
}

Result<std::vector<double>> coordinatesOf(const VtuFile& file, const VtuDocument& document,
                                          const VtuArray& array, std::uint64_t count) {
  std::vector<double> out;
  if (array.components != 1)
    return file.bad(array.called() + " has " + std::to_string(array.components) +
                    " components, not one; the file is damaged, export it again");
  const Status done = readReals(file, document, array, {count, 0, count}, [&](auto numbers) {
    out.insert(out.end(), numbers.begin(), numbers.end());
  });
  if (!done) return std::unexpected(done.error());
  return out;
}

Status addRectilinear(const VtuFile& file, const VtuDocument& document, const VtuPiece& piece,
                      std::vector<Position>& points) {
  if (piece.axisCoordinates.size() != 3)
    return file.bad("line " + std::to_string(piece.line) +
                    ": a <Piece> has not three arrays in <Coordinates>; the file is damaged, "
                    "export it again");
  const Counts counts = pointsAlong(piece);
  std::array<std::vector<double>, 3> axes;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    auto read = coordinatesOf(file, document, piece.axisCoordinates[axis], counts[axis]);
    if (!read) return std::unexpected(read.error());
    axes[axis] = std::move(*read);
  }
  forEachPlace(counts, [&](std::uint64_t i, std::uint64_t j, std::uint64_t k) {
    points.push_back({axes[0][i], axes[1][j], axes[2][k]});
  });
  return {};
}

/// As vtkImageData computes them: origin + direction * spacing * place.
void addImage(const VtuDocument& document, const VtuPiece& piece, std::vector<Position>& points) {
  std::array<double, 9> step{};
  for (std::size_t i = 0; i < step.size(); ++i)
    step[i] = document.direction[i] * document.spacing[i % 3];
  const auto at = [&](std::size_t axis, std::uint64_t place) {
    return static_cast<double>(piece.extent[2 * axis] + static_cast<std::int64_t>(place));
  };
  forEachPlace(pointsAlong(piece), [&](std::uint64_t i, std::uint64_t j, std::uint64_t k) {
    const double x = at(0, i), y = at(1, j), z = at(2, k);
    Position& point = points.emplace_back();
    for (std::size_t a = 0; a < 3; ++a)
      point[a] = step[3 * a] * x + step[3 * a + 1] * y + step[3 * a + 2] * z + document.origin[a];
  });
}

/// Marks the points that are blanked out; empty: none is.
Result<std::vector<bool>> hiddenPoints(const VtuFile& file, const VtuDocument& document,
                                       const VtuPiece& piece) {
  std::vector<bool> out;
  const auto& arrays = piece.pointFields.arrays;
  const auto marks = std::ranges::find(arrays, kGhostTypes, &VtuArray::name);
  if (marks == arrays.end() || marks->type != NumberType::kUInt8 || marks->components != 1)
    return out;
  const Status done =
      readIntegers(file, document, *marks, {piece.points, 0, piece.points}, [&](auto numbers) {
        for (const std::int64_t mark : numbers) out.push_back((mark & kHiddenPoint) != 0);
      });
  if (!done) return std::unexpected(done.error());
  return out;
}

}  // namespace

Status addGridPoints(const VtuFile& file, const VtuDocument& document, const VtuPiece& piece,
                     std::vector<Position>& points) {
  assert(document.kind == GridKind::kRectilinear || document.kind == GridKind::kImage);
  if (document.kind == GridKind::kRectilinear) return addRectilinear(file, document, piece, points);
  addImage(document, piece, points);
  return {};
}

Status addGridCells(const VtuFile& file, const VtuDocument& document, const VtuPiece& piece,
                    CellMesh& out, KeptRows& rows, ReadReport& report) {
  assert(document.kind != GridKind::kUnstructured);
  const auto hidden = hiddenCells(file, document, piece);
  if (!hidden) return std::unexpected(hidden.error());
  const Counts points = pointsAlong(piece);
  if (std::ranges::any_of(points, [](std::uint64_t count) { return count < 2; })) {
    for (std::uint64_t i = 0; i < piece.cells; ++i) {
      if (hidden->empty() || !(*hidden)[i]) ++report.ignoredCells;
      rows.drop();
    }
    return {};
  }
  const bool isStructured = document.kind == GridKind::kStructured;
  const auto blanked =
      isStructured ? hiddenPoints(file, document, piece) : Result<std::vector<bool>>{};
  if (!blanked) return std::unexpected(blanked.error());
  const std::uint64_t row = points[0], layer = points[0] * points[1];
  forEachPlace({points[0] - 1, points[1] - 1, points[2] - 1}, [&](std::uint64_t i, std::uint64_t j,
                                                                  std::uint64_t k) {
    const std::uint64_t a = i + j * row + k * layer;
    std::array<std::uint64_t, 8> corners{
        a,         a + 1,         a + row,         a + row + 1,
        a + layer, a + layer + 1, a + layer + row, a + layer + row + 1};
    if (isStructured) std::swap(corners[2], corners[3]), std::swap(corners[6], corners[7]);
    const bool isHidden =
        (!hidden->empty() && (*hidden)[rows.next()]) ||
        (!blanked->empty() &&
         std::ranges::any_of(corners, [&](std::uint64_t point) { return (*blanked)[point]; }));
    if (isHidden) return rows.drop();
    for (const std::uint64_t corner : corners)
      out.vertices.push_back(narrowedId(static_cast<std::int64_t>(corner)));
    // a voxel names its corners along the axes, a hexahedron round its faces
    out.types.push_back(isStructured ? kHexahedronCell : kVoxelCell);
    out.begins.push_back(out.vertices.size());
    rows.keep();
  });
  return {};
}

}  // namespace qtet
