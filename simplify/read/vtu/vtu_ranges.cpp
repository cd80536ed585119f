#include "simplify/read/vtu/vtu_ranges.h"

#include <algorithm>
#include <cassert>
#include <string_view>

#include "simplify/read/options/grid_parts.h"
#include "simplify/read/vtu/vtu_numbers.h"

namespace qtet {
namespace {

/// `told` and the range count numbers.
Result<std::vector<double>> realsOf(const VtuFile& file, const VtuDocument& document,
                                    const VtuArray& array, const NumberRange& range) {
  std::vector<double> out;
  out.reserve(range.count);
  const Status done = readReals(file, document, array, range, [&](std::span<const double> some) {
    out.insert(out.end(), some.begin(), some.end());
  });
  if (!done) return std::unexpected(done.error());
  return out;
}

/// The integers of an array of <Cells>, of which the file has `told`.
Result<std::vector<std::int64_t>> integersOf(const VtuFile& file, const VtuDocument& document,
                                             const VtuPiece& piece, std::string_view name,
                                             const NumberRange& range) {
  const auto array = std::ranges::find(piece.cellArrays, name, &VtuArray::name);
  if (array == piece.cellArrays.end() || array->components != 1)
    return file.bad("line " + std::to_string(piece.line) + ": a <Piece> has cells, but no array " +
                    std::string(name) +
                    " of one component in <Cells>; the file is damaged, export it again");
  std::vector<std::int64_t> out;
  out.reserve(range.count);
  const Status done = readIntegers(
      file, document, *array, range,
      [&](std::span<const std::int64_t> some) { out.insert(out.end(), some.begin(), some.end()); });
  if (!done) return std::unexpected(done.error());
  return out;
}

}  // namespace

Result<std::vector<Position>> readVtuPointRange(const VtuFile& file, const VtuDocument& document,
                                                const VtuPiece& piece, const VtuRange& range) {
  assert(range.first <= piece.points && range.count <= piece.points - range.first);
  if (!piece.coordinates || piece.coordinates->components != 3)
    return file.bad("line " + std::to_string(piece.line) +
                    ": a <Piece> has no array of 3 components in <Points>; the file is damaged, "
                    "export it again");
  const auto values = readVtuValueRange(file, document, *piece.coordinates, piece.points, range);
  if (!values) return std::unexpected(values.error());
  std::vector<Position> out(range.count);
  for (std::size_t i = 0; i < values->size(); ++i) out[i / 3][i % 3] = (*values)[i];
  return out;
}

Result<CellMesh> readVtuCellRange(const VtuFile& file, const VtuDocument& document,
                                  const VtuPiece& piece, const VtuRange& range) {
  assert(range.first <= piece.cells && range.count <= piece.cells - range.first);
  CellMesh out;
  if (range.count == 0) return out;
  const auto types =
      integersOf(file, document, piece, "types", {piece.cells, range.first, range.count});
  if (!types) return std::unexpected(types.error());
  // the end of the cell before the range is where it begins
  const std::uint64_t before = range.first > 0 ? 1 : 0;
  auto ends = integersOf(file, document, piece, "offsets",
                         {piece.cells, range.first - before, range.count + before});
  if (!ends) return std::unexpected(ends.error());
  if (before == 0) ends->insert(ends->begin(), 0);
  for (std::size_t i = 0; i < types->size(); ++i) {
    const std::int64_t type = (*types)[i];
    if (type < 0 || type > 255 || (*ends)[i] < 0 || (*ends)[i + 1] < (*ends)[i])
      return file.bad(verticesOutside(range.first + i));
    if (type == kPolyhedronCell)
      return file.bad("cell " + std::to_string(range.first + i) +
                      " is a polyhedron, which is read with the whole file alone");
  }
  const auto begin = static_cast<std::uint64_t>(ends->front()),
             end = static_cast<std::uint64_t>(ends->back());
  // what stands behind the range is not known, so an ascii list may go on
  const auto connectivity =
      std::ranges::find(piece.cellArrays, std::string_view("connectivity"), &VtuArray::name);
  std::uint64_t told = end;
  if (connectivity != piece.cellArrays.end() && connectivity->place == VtuArray::Place::kAscii &&
      range.first + range.count < piece.cells) {
    const auto last =
        integersOf(file, document, piece, "offsets", {piece.cells, piece.cells - 1, 1});
    if (!last) return std::unexpected(last.error());
    told = std::max<std::uint64_t>(
        end, static_cast<std::uint64_t>(std::max<std::int64_t>(last->front(), 0)));
  }
  const auto ids = integersOf(file, document, piece, "connectivity", {told, begin, end - begin});
  if (!ids) return std::unexpected(ids.error());
  assert(ids->size() == end - begin && types->size() == range.count);
  out.vertices.reserve(ids->size());
  for (const std::int64_t id : *ids)
    out.vertices.push_back(std::cmp_less(id, piece.points) ? narrowedId(id) : kGhost);
  for (std::size_t i = 0; i < types->size(); ++i) {
    out.types.push_back(static_cast<std::uint8_t>((*types)[i]));
    out.begins.push_back(static_cast<std::uint64_t>((*ends)[i + 1]) - begin);
    out.cellIds.push_back(range.first + i);
  }
  return out;
}

Result<std::vector<double>> readVtuValueRange(const VtuFile& file, const VtuDocument& document,
                                              const VtuArray& array, std::uint64_t tuples,
                                              const VtuRange& range) {
  assert(range.first <= tuples && range.count <= tuples - range.first);
  std::uint64_t told = 0;
  if (__builtin_mul_overflow(tuples, std::uint64_t{array.components}, &told))
    return file.bad(array.called() +
                    " would have more than 2^64 numbers; the file is damaged, export it again");
  // before anything is allocated: its bytes must hold what the counts say
  if (const auto certain = certainNumbers(file, document, array, told); !certain)
    return std::unexpected(certain.error());
  return realsOf(file, document, array,
                 {told, range.first * array.components, range.count * array.components});
}

}  // namespace qtet
