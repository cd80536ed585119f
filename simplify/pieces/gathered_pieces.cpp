#include "simplify/pieces/gathered_pieces.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>
#include <utility>

#include "codec/mesh/boundary.h"
#include "simplify/blocks/array_bytes.h"
#include "simplify/mesh/cell_faces.h"
#include "simplify/mesh/stopping.h"

namespace qtet {
namespace {

/// Leaves the tuples of `kept`, in that order.
template <class T>
void keep(std::vector<T>& values, std::span<const std::uint32_t> kept, std::size_t components) {
  std::vector<T> out;
  out.reserve(kept.size() * components);
  for (const std::uint32_t i : kept)
    for (std::size_t c = 0; c < components; ++c) out.push_back(values[i * components + c]);
  values = std::move(out);
}

void keepFields(TetMesh& mesh, std::span<const std::uint32_t> kept, bool ofCells) {
  for (MeshField& field : mesh.fields)
    if (isCellField(field) == ofCells) keep(field.values, kept, field.components);
}

/// Puts the points in that order, and leaves out those that are not in it.
void orderPoints(TetMesh& mesh, std::vector<WholeVertex>& vertices,
                 std::span<const std::uint32_t> order) {
  std::vector<VertexId> numbers(vertices.size(), kGhost);
  for (VertexId i = 0; i < order.size(); ++i) numbers[order[i]] = i;
  keep(vertices, order, 1);
  keep(mesh.points, order, 1);
  keepFields(mesh, order, false);
  for (Tetrahedron& cell : mesh.tetrahedra)
    for (VertexId& v : cell) v = numbers[v];
}

/// Drops points that no cell has.
void dropUnused(TetMesh& mesh, std::vector<WholeVertex>& vertices) {
  std::vector<std::uint8_t> isUsed(vertices.size());
  for (const Tetrahedron& cell : mesh.tetrahedra)
    for (const VertexId v : cell) isUsed[v] = 1;
  std::vector<std::uint32_t> kept;
  for (VertexId v = 0; v < isUsed.size(); ++v)
    if (isUsed[v]) kept.push_back(v);
  if (kept.size() < vertices.size()) orderPoints(mesh, vertices, kept);
}

/// Orders coordinates; the sign of 0 does not count.
bool isBefore(const Position& a, const Position& b) {
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (a[axis] != b[axis]) return a[axis] < b[axis];
  return false;
}

}  // namespace

Result<GatheredPieces> GatheredPieces::of(InputPieces& input, const MakeSpool& make,
                                          const std::stop_token& stop) {
  Result<PieceSpool> spool = PieceSpool::made(make);
  if (!spool) return std::unexpected(spool.error());
  GatheredPieces out(std::move(*spool));
  const bool hasParts = input.parts() > 1;
  out.points_ = input.points();
  out.marks_.emplace(out.points_);
  while (true) {
    throwIfStopped(stop);
    Result<std::optional<InputPiece>> piece = input.next();
    if (!piece) return std::unexpected(piece.error());
    if (!*piece) break;
    if (hasParts) out.addSeams(**piece);
    if (Status s = out.take(std::move(**piece)); !s) return std::unexpected(s.error());
  }
  if (out.count() == 0)
    return fail(ErrorCode::kBadInput,
                "no cell has four different vertices, so there is nothing to simplify; export the "
                "volume mesh again");
  if (Status s = out.joinSeams(); !s) return std::unexpected(s.error());
  if (Status s = out.takeOwnersValues(); !s) return std::unexpected(s.error());
  return out;
}

Status GatheredPieces::take(InputPiece&& given) {
  TetMesh& mesh = given.mesh;
  if (shapes_.empty() && extremes_.empty()) takeShape(mesh);
  std::vector<std::uint32_t> kept;
  for (CellId c = 0; c < mesh.tetrahedra.size(); ++c) {
    if (repeatsAVertex(mesh.tetrahedra[c]))
      repeating_.add(given.firstCell + c);
    else
      kept.push_back(c);
  }
  cells_ = given.firstCell + mesh.tetrahedra.size();
  std::vector<std::uint64_t> numbers;
  if (kept.size() < mesh.tetrahedra.size()) {
    for (const std::uint32_t c : kept) numbers.push_back(given.firstCell + c);
    keep(mesh.tetrahedra, kept, 1);
    keepFields(mesh, kept, true);
  }
  if (mesh.tetrahedra.empty()) return {};
  dropUnused(mesh, given.vertices);
  box_.include(mesh.points);
  for (const WholeVertex v : given.vertices) marks_->meet(v);
  ArrayWriter writer;
  writer.put(given.vertices);
  writer.put(mesh.points);
  writer.put(mesh.tetrahedra);
  writer.put(numbers);
  writer.put(std::vector{given.firstCell});
  for (std::size_t f = 0; f < mesh.fields.size(); ++f) {
    extremes_[f].add(mesh.fields[f]);
    writer.put(mesh.fields[f].values);
  }
  return spool_.add(writer.take());
}

void GatheredPieces::takeShape(const TetMesh& mesh) {
  pointType_ = mesh.pointType;
  for (const MeshField& field : mesh.fields) {
    shapes_.push_back(withoutValues(field));
    extremes_.emplace_back(field);
    if (!isCellField(field)) valuesOfPoint_ += field.components;
  }
}

void GatheredPieces::addSeams(const InputPiece& piece) {
  std::vector<Tetrahedron> sound;
  std::ranges::remove_copy_if(piece.mesh.tetrahedra, std::back_inserter(sound), repeatsAVertex);
  std::vector<std::uint8_t> isThere(piece.vertices.size());
  for (const Triangle& t : boundaryOf(sound))
    for (const VertexId v : t)
      if (std::exchange(isThere[v], std::uint8_t{1}) == 0)
        seams_.push_back({piece.mesh.points[v], piece.vertices[v], piece.part});
}

Status GatheredPieces::joinSeams() {
  std::vector<Seam> seams = std::move(seams_);
  std::ranges::sort(seams, [](const Seam& a, const Seam& b) {
    if (isBefore(a.at, b.at) || isBefore(b.at, a.at)) return isBefore(a.at, b.at);
    return a.vertex < b.vertex;
  });
  const auto repeated = std::ranges::unique(seams, {}, &Seam::vertex);
  seams.erase(repeated.begin(), repeated.end());
  for (std::size_t begin = 0, end = 0; begin < seams.size(); begin = end) {
    end = begin + 1;
    bool isClear = true;  // no part has two points here: parts ascend with the vertices
    while (end < seams.size() && !isBefore(seams[begin].at, seams[end].at)) {
      isClear = isClear && seams[end].part != seams[end - 1].part;
      ++end;
    }
    if (end == begin + 1 || seams[begin].part == seams[end - 1].part) continue;
    if (!isClear)
      return fail(ErrorCode::kBadInput,
                  "points " + std::to_string(seams[begin].vertex) + " to " +
                      std::to_string(seams[end - 1].vertex) +
                      " of several pieces lie at one place, where a piece has more than one; which "
                      "of them are one point is found with the whole mesh alone: read it without "
                      "`memory`");
    for (std::size_t i = begin + 1; i < end; ++i) {
      joined_.push_back({seams[i].vertex, seams[begin].vertex});
      marks_->join(seams[i].vertex, seams[begin].vertex);
    }
    owners_.push_back(seams[begin].vertex);
  }
  std::ranges::sort(joined_, {}, &Joined::vertex);
  std::ranges::sort(owners_);
  return {};
}

WholeVertex GatheredPieces::ownerOf(WholeVertex v) const {
  const auto at = std::ranges::lower_bound(joined_, v, {}, &Joined::vertex);
  return at != joined_.end() && at->vertex == v ? at->owner : v;
}

std::optional<std::size_t> GatheredPieces::valuesOf(WholeVertex owner) const {
  const auto at = std::ranges::lower_bound(owners_, owner);
  if (at == owners_.end() || *at != owner) return std::nullopt;
  return static_cast<std::size_t>(at - owners_.begin()) * valuesOfPoint_;
}

/// An owner has its own values, and where these are missing those of the others, in their order.
Status GatheredPieces::takeOwnersValues() {
  if (owners_.empty() || valuesOfPoint_ == 0) return {};
  constexpr double kMissingValue = std::numeric_limits<double>::quiet_NaN();
  ownersValues_.assign(owners_.size() * valuesOfPoint_, kMissingValue);
  for (std::size_t i = 0; i < count(); ++i) {
    const Result<GatheredPiece> piece = stored(i);
    if (!piece) return std::unexpected(piece.error());
    for (VertexId v = 0; v < piece->vertices.size(); ++v) {
      const std::optional<std::size_t> first = valuesOf(ownerOf(piece->vertices[v]));
      if (!first) continue;
      std::size_t to = *first;
      for (const MeshField& field : piece->mesh.fields) {
        if (isCellField(field)) continue;
        for (std::size_t c = 0; c < field.components; ++c, ++to)
          if (std::isnan(ownersValues_[to]))
            ownersValues_[to] = field.values[v * std::size_t{field.components} + c];
      }
    }
  }
  return {};
}

Result<GatheredPiece> GatheredPieces::stored(std::size_t number) const {
  const Result<Bytes> bytes = spool_.get(number);
  if (!bytes) return std::unexpected(bytes.error());
  Result<ArrayReader> reader = ArrayReader::of(*bytes);
  if (!reader) return std::unexpected(reader.error());
  GatheredPiece out;
  std::vector<std::uint64_t> first;
  reader->get(out.vertices);
  reader->get(out.mesh.points);
  reader->get(out.mesh.tetrahedra);
  reader->get(out.cells);
  reader->get(first);
  out.mesh.fields = shapes_;
  for (MeshField& field : out.mesh.fields) reader->get(field.values);
  if (!reader->isWhole() || first.size() != 1)
    return fail(ErrorCode::kTruncated, "a piece of the mesh ends early");
  out.firstCell = first.front();
  out.mesh.pointType = pointType_;
  return out;
}

void GatheredPieces::rename(GatheredPiece& piece) const {
  for (VertexId v = 0; v < piece.vertices.size(); ++v) {
    piece.vertices[v] = ownerOf(piece.vertices[v]);
    const std::optional<std::size_t> first = valuesOf(piece.vertices[v]);
    if (!first) continue;
    std::size_t from = *first;
    for (MeshField& field : piece.mesh.fields) {
      if (isCellField(field)) continue;
      for (std::size_t c = 0; c < field.components; ++c)
        field.values[v * std::size_t{field.components} + c] = ownersValues_[from++];
    }
  }
  std::vector<std::uint32_t> order(piece.vertices.size());
  std::iota(order.begin(), order.end(), 0u);
  std::ranges::sort(order, {}, [&](std::uint32_t v) { return piece.vertices[v]; });
  orderPoints(piece.mesh, piece.vertices, order);
}

Result<GatheredPiece> GatheredPieces::get(std::size_t number) const {
  Result<GatheredPiece> out = stored(number);
  if (out && !joined_.empty()) rename(*out);
  return out;
}

}  // namespace qtet
