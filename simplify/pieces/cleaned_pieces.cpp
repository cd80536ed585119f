#include "simplify/pieces/cleaned_pieces.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>
#include <utility>

#include "codec/mesh/boundary.h"
#include "proto/limits.h"
#include "simplify/clean/float_spacing.h"
#include "simplify/clean/value_bounds.h"
#include "simplify/mesh/missing_values.h"
#include "simplify/mesh/stopping.h"
#include "simplify/mesh/surface_manifold.h"
#include "simplify/mesh/volume_sign.h"

namespace qtet {
namespace {

/// A point of the input, ordered by its place.
struct Place {
  std::array<std::uint64_t, 3> at{};  // the bits of its coordinates
  WholeVertex vertex = 0;

  friend auto operator<=>(const Place&, const Place&) = default;
};

Place placeOf(const Position& p, WholeVertex v) {
  Place out{{}, v};
  for (std::size_t a = 0; a < 3; ++a)
    out.at[a] = std::bit_cast<std::uint64_t>(p[a] + 0.0);  // one zero
  return out;
}

int signOf(const TetMesh& mesh, const Tetrahedron& t) {
  return volumeSign(mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]], mesh.points[t[3]]);
}

template <class T>
void dropTuples(std::vector<T>& values, std::size_t components,
                const std::vector<std::uint8_t>& marks) {
  std::size_t to = 0;
  for (std::size_t i = 0; i < marks.size(); ++i) {
    if (marks[i] & kDroppedCell) continue;
    for (std::size_t c = 0; c < components; ++c) values[to++] = values[i * components + c];
  }
  values.resize(to);
}

}  // namespace

/// Looks at all cleaned pieces once, for the report.
class CleanedPieces::Inspection {
 public:
  Inspection(CleanedPieces& out, RecordBuckets<Place> places)
      : out_(out),
        report_(out.clean_),
        places_(std::move(places)),
        spacing_(out.pieces_.box().low, out.pieces_.box().high) {}

  Status take(const Clean& clean) {
    const TetMesh& mesh = clean.piece.mesh;
    spacing_.add(mesh);
    for (const std::uint64_t number : clean.turned) report_.reorientedCells.add(number);
    for (const std::uint64_t number : clean.dropped) report_.duplicateCells.add(number);
    for (CellId c = 0; c < mesh.tetrahedra.size(); ++c) {
      const Tetrahedron& t = mesh.tetrahedra[c];
      const int sign = signOf(mesh, t);
      if (sign == 0) report_.flatCells.add(clean.numbers[c]);
      if (sign < 0) report_.invertedCells.add(clean.numbers[c]);
      report_.volume += roundedVolume6(mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]],
                                       mesh.points[t[3]]) /
                        6;
    }
    out_.cells_ += mesh.tetrahedra.size();
    out_.triangles_ += clean.boundary.size();
    if (out_.triangles_ <= kMostCheckedTriangles)
      for (const PieceTriangle& t : clean.boundary)
        boundary_.push_back({clean.piece.vertices[t.corners[0]], clean.piece.vertices[t.corners[1]],
                             clean.piece.vertices[t.corners[2]]});
    for (VertexId v = 0; v < clean.piece.vertices.size(); ++v) {
      const Place place = placeOf(mesh.points[v], clean.piece.vertices[v]);
      const std::uint64_t hash = mixed(mixed(mixed(place.at[0]) + place.at[1]) + place.at[2]);
      if (Status s = places_.add(hash, place); !s) return s;
    }
    return {};
  }

  Status end() {
    if (Status s = findCoincident(); !s) return s;
    if (out_.triangles_ <= kMostCheckedTriangles)
      findNonManifold();
    else
      out_.notes_.push_back("the boundary has " + std::to_string(out_.triangles_) +
                            " triangles, too many to look for edges and points at which it is no "
                            "surface");
    if (auto lost = spacing_.lost()) out_.quantise_.notes.push_back(std::move(*lost));
    const VertexMarks& marks = out_.pieces_.marks();
    const std::uint64_t points = out_.pieces_.points(), joined = out_.pieces_.joinedPoints();
    if (const std::uint64_t used = marks.metPoints() + joined; used < points) {
      report_.unusedPoints.count = points - used;
      if (joined == 0)
        for (WholeVertex v = 0;
             v < points && report_.unusedPoints.first.size() < Occurrences::kShown; ++v)
          if (!marks.isMet(v)) report_.unusedPoints.first.push_back(v);
    }
    return {};
  }

 private:
  Status findCoincident() {
    std::vector<WholeVertex> later;
    const Status done = places_.forEach([&](const std::vector<Place>& places) -> Status {
      for (std::size_t i = 1; i < places.size(); ++i)
        if (places[i].at == places[i - 1].at && places[i].vertex != places[i - 1].vertex)
          later.push_back(places[i].vertex);
      return {};
    });
    if (!done) return done;
    std::ranges::sort(later);
    for (const WholeVertex v : later) report_.coincidentPoints.add(v);
    return {};
  }

  void findNonManifold() {
    std::vector<WholeVertex> names;
    for (const auto& t : boundary_) names.insert(names.end(), t.begin(), t.end());
    std::ranges::sort(names);
    const auto repeated = std::ranges::unique(names);
    names.erase(repeated.begin(), repeated.end());
    std::vector<Triangle> triangles;
    for (const auto& t : boundary_) {
      Triangle& own = triangles.emplace_back();
      for (std::size_t i = 0; i < 3; ++i)
        own[i] = static_cast<VertexId>(std::ranges::lower_bound(names, t[i]) - names.begin());
    }
    boundary_ = {};
    const NonManifoldParts parts = nonManifoldPartsOf(triangles);
    for (const auto& [low, high] : parts.edges) {
      report_.nonManifoldEdges.add(names[low]);
      if (report_.nonManifoldEdges.count <= Occurrences::kShown)
        report_.nonManifoldEdgeEnds.push_back(names[high]);
    }
    for (const VertexId v : parts.vertices) report_.nonManifoldVertices.add(names[v]);
  }

  CleanedPieces& out_;
  CleanReport& report_;
  RecordBuckets<Place> places_;
  FloatSpacing spacing_;
  std::vector<std::array<WholeVertex, 3>> boundary_;
};

Result<CleanedPieces> CleanedPieces::of(InputPieces& input, const CleaningOptions& options) {
  return orCancelled([&]() -> Result<CleanedPieces> {
    if (Status s = checkQuantiseOptions(options.quantise); !s) return std::unexpected(s.error());
    Result<GatheredPieces> gathered = GatheredPieces::of(input, options.spool, options.stop);
    if (!gathered) return std::unexpected(gathered.error());
    Result<PieceFaces> faces = PieceFaces::of(*gathered, options.spool, options.stop);
    if (!faces) return std::unexpected(faces.error());
    CleanedPieces out(std::move(*gathered), std::move(*faces), options.stop);
    if (Status s = checkBox(out.pieces_.box()); !s) return std::unexpected(s.error());
    if (Status s = out.inspect(options.spool); !s) return std::unexpected(s.error());
    if (Status s = out.chooseLattice(options.quantise); !s) return std::unexpected(s.error());
    if (Status s = out.chooseFields(options); !s) return std::unexpected(s.error());
    return out;
  });
}

Status CleanedPieces::inspect(const MakeSpool& make) {
  Result<RecordBuckets<Place>> places = RecordBuckets<Place>::made(make);
  if (!places) return std::unexpected(places.error());
  Inspection inspection(*this, std::move(*places));
  for (std::size_t i = 0; i < pieces_.count(); ++i) {
    const Result<Clean> clean = cleaned(i);
    if (!clean) return std::unexpected(clean.error());
    if (Status s = inspection.take(*clean); !s) return s;
  }
  clean_.repeatedVertexCells = pieces_.repeating();
  clean_.components = faces_.components();
  clean_.box = {pieces_.box().low, pieces_.box().high};
  return inspection.end();
}

Status CleanedPieces::chooseLattice(const QuantiseOptions& options) {
  quantise_.requestedBits = options.positionBits;
  for (int bits = options.positionBits;; ++bits) {
    lattice_ = latticeOf(pieces_.box(), bits);
    const Result<Occurrences> worse = worseAt(lattice_);
    if (!worse) return std::unexpected(worse.error());
    quantise_.worseCells = *worse;
    if (bits == options.positionBits) quantise_.worseAtRequestedBits = worse->count;
    if (worse->count == 0 || bits == kMaxPositionBits) break;
  }
  notePositions(lattice_.bits, quantise_);
  return checkWorse(cells_, pieces_.box(), quantise_);
}

Result<Occurrences> CleanedPieces::worseAt(const Lattice& lattice) const {
  Occurrences out;
  std::uint64_t first = 0;
  for (std::size_t i = 0; i < pieces_.count(); ++i) {
    const Result<Clean> clean = cleaned(i);
    if (!clean) return std::unexpected(clean.error());
    const TetMesh& mesh = clean->piece.mesh;
    const std::vector<LatticePoint> points = onLattice(mesh.points, lattice);
    for (CellId c = 0; c < mesh.tetrahedra.size(); ++c) {
      const Tetrahedron& t = mesh.tetrahedra[c];
      if (isWorse(signOf(mesh, t), {points[t[0]], points[t[1]], points[t[2]], points[t[3]]}))
        out.add(first + c);
    }
    first += mesh.tetrahedra.size();
  }
  return out;
}

/// A few values of each field decide its scale, and stand for all here.
Status CleanedPieces::chooseFields(const CleaningOptions& options) {
  std::vector<MeshField> few;
  for (const FieldExtremes& field : pieces_.extremes()) few.push_back(field.field());
  if (Status s = checkValueBounds(few, options.quantise.errors, options.units); !s) return s;
  Result<PlacedFields> placed = placeFields(few, options.quantise, stop_);
  if (!placed) return std::unexpected(placed.error());
  for (const QuantisedField& field : placed->fields) fields_.push_back(field.info);
  filled_.resize(fields_.size());
  quantise_.nonFiniteOf.resize(fields_.size());
  if (std::ranges::any_of(fields_, &FieldInfo::hasMissing)) {
    const Status filled = forEach([&](GivenPiece&& given) -> Status {
      for (std::size_t f = 0; f < fields_.size(); ++f) fillShared(given, f);
      return {};
    });
    if (!filled) return filled;
  }
  noteFields(*placed, fields_, quantise_);
  return {};
}

/// Counts the missing values. The first piece that has a shared vertex says what it has in their
/// place.
void CleanedPieces::fillShared(const GivenPiece& given, std::size_t field) {
  const MeshPiece& piece = given.piece;
  const std::vector<std::uint8_t>& missing = piece.missing[field];
  const std::size_t n = fields_[field].components;
  for (std::size_t i = 0; i < missing.size(); i += n) {
    const auto first = missing.begin() + static_cast<std::ptrdiff_t>(i);
    const auto count = std::count(first, first + static_cast<std::ptrdiff_t>(n), 1);
    if (count == 0) continue;
    if (!isCellField(fields_[field]) && pieces_.marks().isShared(piece.vertices[i / n])) {
      const auto value = piece.values[field].begin() + static_cast<std::ptrdiff_t>(i);
      const bool isNew =
          filled_[field]
              .try_emplace(piece.vertices[i / n],
                           std::vector(value, value + static_cast<std::ptrdiff_t>(n)))
              .second;
      if (!isNew) continue;
    }
    quantise_.nonFiniteOf[field] += static_cast<std::uint64_t>(count);
  }
}

Result<CleanedPieces::Clean> CleanedPieces::cleaned(std::size_t number) const {
  throwIfStopped(stop_);
  Result<GatheredPiece> piece = pieces_.get(number);
  if (!piece) return std::unexpected(piece.error());
  const Result<std::vector<std::uint8_t>> marks = faces_.marksOf(number);
  if (!marks) return std::unexpected(marks.error());
  Clean out{.piece = std::move(*piece)};
  TetMesh& mesh = out.piece.mesh;
  std::vector<Tetrahedron> cells;
  for (CellId c = 0; c < mesh.tetrahedra.size(); ++c) {
    const std::uint8_t mark = (*marks)[c];
    if (mark & kDroppedCell) {
      out.dropped.push_back(out.piece.numberOf(c));
      continue;
    }
    Tetrahedron t = mesh.tetrahedra[c];
    const bool isTurned = mark & kTurnedCell;
    if (isTurned) std::swap(t[2], t[3]), out.turned.push_back(out.piece.numberOf(c));
    for (int corner = 0; corner < 4; ++corner) {
      const int before = isTurned && corner >= 2 ? 5 - corner : corner;
      if (mark & (1 << before))
        out.boundary.push_back({cellFace(t, corner), static_cast<CellId>(cells.size())});
    }
    cells.push_back(t);
    out.numbers.push_back(out.piece.numberOf(c));
  }
  if (cells.size() < mesh.tetrahedra.size())
    for (MeshField& field : mesh.fields)
      if (isCellField(field)) dropTuples(field.values, field.components, *marks);
  mesh.tetrahedra = std::move(cells);
  return out;
}

Status CleanedPieces::forEach(const TakePiece& take) {
  std::uint32_t number = 0;
  for (std::size_t i = 0; i < pieces_.count(); ++i) {
    Result<Clean> clean = cleaned(i);
    if (!clean) return std::unexpected(clean.error());
    GivenPiece out;
    out.number = number++;
    out.isLast = i + 1 == pieces_.count();
    out.piece.points = onLattice(clean->piece.mesh.points, lattice_);
    out.piece.vertices = std::move(clean->piece.vertices);
    out.piece.tetrahedra = std::move(clean->piece.mesh.tetrahedra);
    out.piece.boundary = std::move(clean->boundary);
    for (const WholeVertex v : out.piece.vertices)
      if (pieces_.marks().isShared(v)) out.shared.push_back(v);
    placeValues(*clean, out.piece);
    if (Status s = take(std::move(out)); !s) return s;
  }
  return {};
}

void CleanedPieces::placeValues(const Clean& from, MeshPiece& to) const {
  to.values.resize(fields_.size());
  to.missing.resize(fields_.size());
  for (std::size_t f = 0; f < fields_.size(); ++f) {
    const std::vector<double>& values = from.piece.mesh.fields[f].values;
    std::vector<std::uint8_t>& missing = to.missing[f];
    if (fields_[f].hasMissing) missing.assign(values.size(), 0);
    to.values[f].reserve(values.size());
    bool isAnyMissing = false;
    for (std::size_t i = 0; i < values.size(); ++i) {
      const bool isFinite = std::isfinite(values[i]);
      const auto component = static_cast<std::uint32_t>(i % fields_[f].components);
      to.values[f].push_back(isFinite ? fieldInteger(fields_[f], component, values[i]) : 0);
      if (isFinite) continue;
      missing[i] = 1;
      isAnyMissing = true;
    }
    if (isAnyMissing) fill(f, to, missing, to.values[f]);
  }
}

/// Fills from the piece alone, and from what shared vertices have. `missing` is a copy: these do
/// not count as missing while others are filled.
void CleanedPieces::fill(std::size_t field, const MeshPiece& piece,
                         std::vector<std::uint8_t> missing,
                         std::vector<std::int32_t>& values) const {
  const std::size_t n = fields_[field].components;
  if (!isCellField(fields_[field]))
    for (std::size_t v = 0; v < piece.vertices.size(); ++v) {
      if (!pieces_.marks().isShared(piece.vertices[v])) continue;
      const auto at = filled_[field].find(piece.vertices[v]);
      for (std::size_t c = 0; at != filled_[field].end() && c < n; ++c)
        if (std::exchange(missing[v * n + c], std::uint8_t{0}) != 0)
          values[v * n + c] = at->second[c];
    }
  fillMissing(piece.tetrahedra, fields_[field], missing, values);
}

}  // namespace qtet
