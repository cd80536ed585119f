#include "simplify/blocks/mesh_piece.h"

#include <algorithm>
#include <cassert>
#include <utility>

#include "simplify/blocks/array_bytes.h"

namespace qtet {
namespace {

/// Appends element `i` of rows of `n` numbers.
template <class T>
void appendRow(const std::vector<T>& from, std::size_t i, std::size_t n, std::vector<T>& to) {
  if (from.empty()) return;
  assert((i + 1) * n <= from.size());
  const auto first = from.begin() + static_cast<std::ptrdiff_t>(i * n);
  to.insert(to.end(), first, first + static_cast<std::ptrdiff_t>(n));
}

std::size_t widthOf(const FieldInfo& field) { return field.components; }

void resizeFields(const PieceShape& shape, MeshPiece& out) {
  out.values.resize(shape.fields.size());
  out.missing.resize(shape.fields.size());
}

/// Takes a vertex of `from`, but for its quadric.
void appendVertex(const MeshPiece& from, const PieceShape& shape, VertexId v, MeshPiece& to) {
  to.vertices.push_back(from.vertices[v]);
  to.points.push_back(from.points[v]);
  for (std::size_t f = 0; f < shape.fields.size(); ++f) {
    if (isCellField(shape.fields[f])) continue;
    appendRow(from.values[f], v, widthOf(shape.fields[f]), to.values[f]);
    appendRow(from.missing[f], v, widthOf(shape.fields[f]), to.missing[f]);
  }
}

void appendCellValues(const MeshPiece& from, const PieceShape& shape, CellId c, MeshPiece& to) {
  for (std::size_t f = 0; f < shape.fields.size(); ++f) {
    if (!isCellField(shape.fields[f])) continue;
    appendRow(from.values[f], c, widthOf(shape.fields[f]), to.values[f]);
    appendRow(from.missing[f], c, widthOf(shape.fields[f]), to.missing[f]);
  }
}

/// Calls give(member) for each array of the piece, in their order in its bytes.
template <class Piece, class Give>
void forEachArray(Piece& piece, const Give& give) {
  give(piece.vertices), give(piece.points), give(piece.values), give(piece.missing);
  give(piece.quadrics), give(piece.tetrahedra), give(piece.boundary), give(piece.places);
}

/// The vertices of all pieces, ascending, each once.
std::vector<WholeVertex> verticesOf(std::span<const MeshPiece> pieces) {
  std::vector<WholeVertex> out;
  for (const MeshPiece& piece : pieces)
    out.insert(out.end(), piece.vertices.begin(), piece.vertices.end());
  std::ranges::sort(out);
  const auto same = std::ranges::unique(out);
  out.erase(same.begin(), same.end());
  return out;
}

/// The numbers of a piece's vertices among `all`.
std::vector<VertexId> numbersIn(const std::vector<WholeVertex>& all, const MeshPiece& piece) {
  std::vector<VertexId> out;
  out.reserve(piece.vertices.size());
  auto at = all.begin();
  for (const WholeVertex v : piece.vertices) {
    at = std::lower_bound(at, all.end(), v);
    assert(at != all.end() && *at == v);
    out.push_back(static_cast<VertexId>(at - all.begin()));
  }
  return out;
}

/// Takes sets of cells out of a piece, with their vertices and values.
class VertexDealer {
 public:
  VertexDealer(const MeshPiece& piece, const PieceShape& shape)
      : piece_(piece),
        shape_(shape),
        numbers_(piece.vertices.size(), kGhost),
        timesTaken_(piece.vertices.size(), 0) {}

  /// The cell is in none of the sets.
  void leaveOut(const Tetrahedron& cell) {
    for (const VertexId v : cell) timesTaken_[v] = 1;
  }
  /// The number of a vertex of a taken piece there.
  [[nodiscard]] VertexId numberOf(VertexId v, const MeshPiece& taken) const {
    const auto at = std::ranges::lower_bound(taken.vertices, piece_.vertices[v]);
    assert(at != taken.vertices.end() && *at == piece_.vertices[v]);
    return static_cast<VertexId>(at - taken.vertices.begin());
  }
  /// The vertices that were taken more than once, ascending.
  [[nodiscard]] std::vector<WholeVertex> ofSeveral() const {
    std::vector<WholeVertex> out;
    for (std::size_t v = 0; v < timesTaken_.size(); ++v)
      if (timesTaken_[v] > 1) out.push_back(piece_.vertices[v]);
    return out;
  }

  MeshPiece take(std::span<const CellId> cells) {
    MeshPiece out;
    resizeFields(shape_, out);
    std::vector<VertexId> used;
    for (const CellId c : cells)
      for (const VertexId v : piece_.tetrahedra[c])
        if (std::exchange(numbers_[v], 0) == kGhost) used.push_back(v);
    std::ranges::sort(used);
    for (VertexId i = 0; i < used.size(); ++i) {
      numbers_[used[i]] = i;
      appendVertex(piece_, shape_, used[i], out);
      takeQuadric(used[i], out);
    }
    for (const CellId c : cells) {
      Tetrahedron& own = out.tetrahedra.emplace_back(piece_.tetrahedra[c]);
      for (VertexId& v : own) v = numbers_[v];
      appendCellValues(piece_, shape_, c, out);
    }
    for (const VertexId v : used) numbers_[v] = kGhost;
    return out;
  }

 private:
  void takeQuadric(VertexId v, MeshPiece& out) {
    const bool isElsewhere = timesTaken_[v] > 0;
    timesTaken_[v] = isElsewhere ? 2 : 1;
    if (piece_.quadrics.empty()) return;
    appendRow(piece_.quadrics, v, shape_.quadricSize, out.quadrics);
    if (isElsewhere)
      std::fill_n(out.quadrics.end() - static_cast<std::ptrdiff_t>(shape_.quadricSize),
                  shape_.quadricSums, 0.0);
  }

  const MeshPiece& piece_;
  const PieceShape& shape_;
  std::vector<VertexId> numbers_;         // of the set in hand; kGhost otherwise
  std::vector<std::uint8_t> timesTaken_;  // 2: or more
};

}  // namespace

WholeVertex newVertex(std::uint32_t band, std::uint32_t block, std::uint32_t index) {
  constexpr int kIndexBits = 32, kBlockBits = 25;
  assert(band + 1 < 1u << 7 && block < 1u << kBlockBits);
  return (static_cast<WholeVertex>(band + 1) << (kIndexBits + kBlockBits)) |
         (static_cast<WholeVertex>(block) << kIndexBits) | index;
}

Result<std::vector<WholeVertex>> deal(const MeshPiece& piece, const PieceShape& shape,
                                      std::span<const std::uint32_t> blockOf, std::uint32_t blocks,
                                      const GivePiece& give) {
  assert(blockOf.size() == piece.tetrahedra.size());
  std::vector<std::vector<CellId>> cells(blocks);
  std::vector<CellId> numbers(blockOf.size());
  VertexDealer dealer(piece, shape);
  for (CellId c = 0; c < blockOf.size(); ++c) {
    if (blockOf[c] == kNoBlock) {
      dealer.leaveOut(piece.tetrahedra[c]);
      continue;
    }
    numbers[c] = static_cast<CellId>(cells[blockOf[c]].size());
    cells[blockOf[c]].push_back(c);
  }
  const auto groupsOf = [&](const auto& elements) {
    std::vector<std::vector<std::uint32_t>> groups(blocks);
    for (std::uint32_t i = 0; i < elements.size(); ++i)
      if (const std::uint32_t block = blockOf[elements[i].tetrahedron]; block != kNoBlock)
        groups[block].push_back(i);
    return groups;
  };
  const auto triangles = groupsOf(piece.boundary), places = groupsOf(piece.places);
  for (std::uint32_t block = 0; block < blocks; ++block) {
    if (cells[block].empty()) continue;
    MeshPiece own = dealer.take(cells[block]);
    for (const std::uint32_t i : triangles[block]) {
      PieceTriangle t = piece.boundary[i];
      for (VertexId& v : t.corners) v = dealer.numberOf(v, own);
      t.tetrahedron = numbers[t.tetrahedron];
      own.boundary.push_back(t);
    }
    for (const std::uint32_t i : places[block]) {
      own.places.push_back(piece.places[i]);
      own.places.back().tetrahedron = numbers[piece.places[i].tetrahedron];
    }
    if (Status given = give(block, std::move(own)); !given) return std::unexpected(given.error());
  }
  return dealer.ofSeveral();
}

MeshPiece joined(std::span<const MeshPiece> pieces, const PieceShape& shape) {
  MeshPiece out;
  resizeFields(shape, out);
  const std::vector<WholeVertex> all = verticesOf(pieces);
  // by vertex: the piece that has it first, and its number there
  constexpr std::uint32_t kNone = ~std::uint32_t{0};
  std::vector<std::array<std::uint32_t, 2>> first(all.size(), {kNone, 0});
  const bool hasQuadrics =
      std::ranges::any_of(pieces, [](const MeshPiece& piece) { return !piece.quadrics.empty(); });
  if (hasQuadrics) out.quadrics.assign(all.size() * shape.quadricSize, 0);
  for (std::uint32_t p = 0; p < pieces.size(); ++p) {
    const MeshPiece& piece = pieces[p];
    const std::vector<VertexId> numbers = numbersIn(all, piece);
    for (VertexId v = 0; v < numbers.size(); ++v) {
      std::array<std::uint32_t, 2>& own = first[numbers[v]];
      const bool isFirst = own[0] == kNone;
      if (isFirst) own = {p, v};
      if (!hasQuadrics) continue;
      const double* from = &piece.quadrics[v * shape.quadricSize];
      double* to = &out.quadrics[numbers[v] * shape.quadricSize];
      for (std::size_t i = 0; i < shape.quadricSums; ++i) to[i] += from[i];
      for (std::size_t i = shape.quadricSums; isFirst && i < shape.quadricSize; ++i)
        to[i] = from[i];
    }
    const auto before = static_cast<CellId>(out.tetrahedra.size());
    for (Tetrahedron cell : piece.tetrahedra) {
      for (VertexId& v : cell) v = numbers[v];
      out.tetrahedra.push_back(cell);
    }
    for (CellId c = 0; c < piece.tetrahedra.size(); ++c) appendCellValues(piece, shape, c, out);
    for (PieceTriangle t : piece.boundary) {
      for (VertexId& v : t.corners) v = numbers[v];
      t.tetrahedron += before;
      out.boundary.push_back(t);
    }
    for (PiecePlace place : piece.places) {
      place.tetrahedron += before;
      out.places.push_back(place);
    }
  }
  for (const auto& [p, v] : first) appendVertex(pieces[p], shape, v, out);
  assert(out.vertices == all);
  return out;
}

Bytes toBytes(const MeshPiece& piece) {
  ArrayWriter writer;
  forEachArray(piece, [&](const auto& array) { writer.put(array); });
  return writer.take();
}

Result<MeshPiece> pieceFrom(ByteView bytes) {
  Result<ArrayReader> reader = ArrayReader::of(bytes);
  if (!reader) return std::unexpected(reader.error());
  MeshPiece out;
  forEachArray(out, [&](auto& array) { reader->get(array); });
  if (!reader->isWhole()) return fail(ErrorCode::kTruncated, "a piece of the mesh ends early");
  return out;
}

}  // namespace qtet
