#include "simplify/pieces/piece_faces.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <span>
#include <utility>

#include "codec/mesh/boundary.h"
#include "simplify/blocks/array_bytes.h"
#include "simplify/clean/clean_mesh.h"
#include "simplify/mesh/cell_faces.h"
#include "simplify/mesh/stopping.h"
#include "simplify/mesh/volume_sign.h"

namespace qtet {
namespace {

constexpr std::uint32_t kNoComponent = ~std::uint32_t{0};

/// Puts the three in order, and says whether that is an odd permutation.
bool sortOdd(std::array<WholeVertex, 3>& t) {
  bool isOdd = false;
  const auto order = [&](std::size_t i, std::size_t j) {
    if (t[i] <= t[j]) return;
    std::swap(t[i], t[j]);
    isOdd = !isOdd;
  };
  order(0, 1), order(1, 2), order(0, 1);
  return isOdd;
}

}  // namespace

/// The faces within one piece.
class PieceFaces::Matching {
 public:
  Matching(const GatheredPiece& piece, const std::stop_token& stop)
      : piece_(piece), stop_(stop), stopped_(stop) {}

  Status match() {
    cells_ = piece_.mesh.tetrahedra;
    for (CellId c = 0; c < cells_.size(); ++c) names_.push_back(c);
    marks.assign(cells_.size(), 0);
    componentOf.assign(cells_.size(), kNoComponent);
    matched_ = matchFaces(cells_, stopped_.get());
    throwIfStopped(stop_);
    dropDuplicates();
    if (!matched_.crowded.empty()) {
      std::vector<std::uint64_t> numbers;
      for (const CellId cell : matched_.firstCrowd)
        numbers.push_back(piece_.numberOf(names_[cell]));
      return overlap(numbers);
    }
    for (CellId c = 0; c < cells_.size(); ++c)
      if (componentOf[names_[c]] == kNoComponent)
        if (Status s = follow(c); !s) return s;
    return {};
  }

  /// Calls give(cell, corner, isBoundary) for each face of a cell that stays.
  template <class Give>
  void forEachFace(const Give& give) const {
    for (CellId c = 0; c < cells_.size(); ++c)
      for (int corner = 0; corner < 4; ++corner)
        give(names_[c], corner,
             matched_.neighbours[c].across[static_cast<std::size_t>(corner)] == kNoCell);
  }

  std::vector<std::uint8_t> marks;         // by cell of the piece, turned against its component
  std::vector<std::uint32_t> componentOf;  // by cell; none for a dropped one
  std::vector<double> volumes;             // by component

 private:
  void dropDuplicates() {
    if (matched_.duplicates.empty()) return;
    for (const CellId cell : matched_.duplicates) marks[cell] = kDroppedCell;
    std::vector<Tetrahedron> kept;
    std::vector<CellId> names;
    for (CellId c = 0; c < cells_.size(); ++c)
      if (marks[c] == 0) kept.push_back(cells_[c]), names.push_back(c);
    cells_ = std::move(kept), names_ = std::move(names);
    matched_ = matchFaces(cells_, stopped_.get());
    throwIfStopped(stop_);
  }

  /// Gives all cells that hang together with `first` a sense that agrees with its own.
  Status follow(CellId first) {
    const auto component = static_cast<std::uint32_t>(volumes.size());
    std::vector<CellId> cells{first};
    componentOf[names_[first]] = component;
    double volume = 0;
    for (std::size_t next = 0; next < cells.size(); ++next) {
      if (next % kLookEvery == 0) throwIfStopped(stop_);
      const CellId cell = cells[next];
      const bool isTurned = marks[names_[cell]] & kTurnedCell;
      const Tetrahedron& t = cells_[cell];
      const std::vector<Position>& points = piece_.mesh.points;
      const double own = roundedVolume6(points[t[0]], points[t[1]], points[t[2]], points[t[3]]);
      volume += isTurned ? -own : own;
      for (std::size_t i = 0; i < 4; ++i) {
        const CellId other = matched_.neighbours[cell].across[i];
        if (other == kNoCell) continue;
        const bool wanted = isTurned != ((matched_.neighbours[cell].disagrees & (1u << i)) != 0);
        std::uint8_t& mark = marks[names_[other]];
        if (componentOf[names_[other]] == kNoComponent) {
          componentOf[names_[other]] = component;
          if (wanted) mark |= kTurnedCell;
          cells.push_back(other);
        } else if (((mark & kTurnedCell) != 0) != wanted) {
          return ringWithoutInside(piece_.numberOf(names_[cell]), piece_.numberOf(names_[other]));
        }
      }
    }
    volumes.push_back(volume);
    return {};
  }

  const GatheredPiece& piece_;
  const std::stop_token& stop_;
  StopFlag stopped_;
  std::vector<Tetrahedron> cells_;  // those that stay
  std::vector<CellId> names_;       // their numbers in the piece
  MatchedFaces matched_;
};

Result<PieceFaces> PieceFaces::of(const GatheredPieces& pieces, const MakeSpool& make,
                                  const std::stop_token& stop) {
  Result<PieceSpool> spool = PieceSpool::made(make);
  if (!spool) return std::unexpected(spool.error());
  Result<RecordBuckets<Face>> buckets = RecordBuckets<Face>::made(make);
  if (!buckets) return std::unexpected(buckets.error());
  PieceFaces out(std::move(*spool), std::move(*buckets));
  for (std::uint32_t number = 0; number < pieces.count(); ++number) {
    const Result<GatheredPiece> piece = pieces.get(number);
    if (!piece) return std::unexpected(piece.error());
    Matching matching(*piece, stop);
    if (Status s = matching.match(); !s) return std::unexpected(s.error());
    const auto first = static_cast<std::uint32_t>(out.component_.size());
    out.firstComponent_.push_back(first);
    for (const double volume : matching.volumes)
      out.component_.push_back({static_cast<std::uint32_t>(out.component_.size()), false, volume});
    Status given;
    matching.forEachFace([&](CellId cell, int corner, bool isBoundary) {
      const Tetrahedron& t = piece->mesh.tetrahedra[cell];
      const Triangle local = cellFace(t, corner);
      Face face{.piece = number, .cell = cell, .corner = static_cast<std::uint16_t>(corner)};
      bool mayBeAcross = true;
      for (std::size_t i = 0; i < 3; ++i) {
        face.vertices[i] = piece->vertices[local[i]];
        mayBeAcross = mayBeAcross && pieces.marks().isShared(face.vertices[i]);
      }
      if (!mayBeAcross) {
        if (isBoundary) matching.marks[cell] |= static_cast<std::uint8_t>(1u << corner);
        return;
      }
      face.opposite = piece->vertices[t[static_cast<std::size_t>(corner)]];
      face.component = first + matching.componentOf[cell];
      face.isOdd = sortOdd(face.vertices) != ((matching.marks[cell] & kTurnedCell) != 0);
      const std::uint64_t hash =
          mixed(mixed(mixed(face.vertices[0]) + face.vertices[1]) + face.vertices[2]);
      if (given) given = out.faces_->add(hash, face);
    });
    if (!given) return std::unexpected(given.error());
    ArrayWriter writer;
    writer.put(matching.marks);
    writer.put(matching.volumes.size() > 1 ? matching.componentOf : std::vector<std::uint32_t>{});
    if (Status s = out.spool_.add(writer.take()); !s) return std::unexpected(s.error());
  }
  if (Status s = out.matchAcross(pieces); !s) return std::unexpected(s.error());
  out.turnComponents();
  return out;
}

Status PieceFaces::matchAcross(const GatheredPieces& pieces) {
  const Status matched = faces_->forEach([&](const std::vector<Face>& faces) -> Status {
    for (std::size_t begin = 0, end = 0; begin < faces.size(); begin = end) {
      while (end < faces.size() && faces[end].vertices == faces[begin].vertices) ++end;
      if (Status s = matchGroup(pieces, std::span(faces).subspan(begin, end - begin)); !s) return s;
    }
    return {};
  });
  faces_.reset();
  std::ranges::sort(found_);
  return matched;
}

/// The cells of one face, ascending. Cells with the same four vertices are one.
Status PieceFaces::matchGroup(const GatheredPieces& pieces, std::span<const Face> group) {
  std::vector<const Face*> sides;
  for (const Face& face : group) {
    const auto same = std::ranges::find(sides, face.opposite, &Face::opposite);
    if (same == sides.end()) {
      sides.push_back(&face);
      continue;
    }
    found_.push_back({face.piece, face.cell, kDroppedCell});
    join((*same)->component, face.component, (*same)->isOdd != face.isOdd);
  }
  if (sides.size() == 1) {
    found_.push_back(
        {sides[0]->piece, sides[0]->cell, static_cast<std::uint8_t>(1u << sides[0]->corner)});
    return {};
  }
  // neighbours that agree turn their face in opposite senses
  const bool fits = sides.size() == 2 && join(sides[0]->component, sides[1]->component,
                                              sides[0]->isOdd == sides[1]->isOdd);
  if (fits) return {};
  std::vector<std::uint64_t> numbers;
  for (const Face* side : sides) {
    const Result<GatheredPiece> piece = pieces.get(side->piece);
    if (!piece) return std::unexpected(piece.error());
    numbers.push_back(piece->numberOf(side->cell));
  }
  return sides.size() > 2 ? overlap(numbers) : ringWithoutInside(numbers[0], numbers[1]);
}

/// False: they hang together already, and the other way round.
bool PieceFaces::join(std::uint32_t a, std::uint32_t b, bool disagree) {
  const auto [setA, flippedA] = setOf(a);
  const auto [setB, flippedB] = setOf(b);
  const bool isFlipped = (flippedA != flippedB) != disagree;
  if (setA == setB) return !isFlipped;
  const auto [low, high] = std::minmax(setA, setB);
  component_[high].parent = low;
  component_[high].isFlipped = isFlipped;
  return true;
}

std::pair<std::uint32_t, bool> PieceFaces::setOf(std::uint32_t component) {
  bool isFlipped = false;
  std::uint32_t set = component;
  for (; component_[set].parent != set; set = component_[set].parent)
    isFlipped = isFlipped != component_[set].isFlipped;
  // shorter next time
  bool left = isFlipped;
  while (component_[component].parent != set && component != set) {
    const std::uint32_t parent = std::exchange(component_[component].parent, set);
    const bool own = std::exchange(component_[component].isFlipped, left);
    left = left != own;
    component = parent;
  }
  return {set, isFlipped};
}

/// Cells are turned so that each set's volume is positive; the first cell decides where it is 0.
void PieceFaces::turnComponents() {
  std::vector<double> volume(component_.size(), 0);
  std::vector<std::uint8_t> isFlipped(component_.size());
  std::vector<std::uint32_t> sets(component_.size());
  for (std::uint32_t c = 0; c < component_.size(); ++c) {
    const auto [set, flipped] = setOf(c);
    sets[c] = set, isFlipped[c] = flipped;
    volume[set] += flipped ? -component_[c].volume : component_[c].volume;
    components_ += set == c ? 1 : 0;
  }
  for (std::uint32_t c = 0; c < component_.size(); ++c)
    isTurned_.push_back((isFlipped[c] != 0) != (volume[sets[c]] < 0));
}

Result<std::vector<std::uint8_t>> PieceFaces::marksOf(std::size_t piece) const {
  const Result<Bytes> bytes = spool_.get(piece);
  if (!bytes) return std::unexpected(bytes.error());
  Result<ArrayReader> reader = ArrayReader::of(*bytes);
  if (!reader) return std::unexpected(reader.error());
  std::vector<std::uint8_t> marks;
  std::vector<std::uint32_t> componentOf;
  reader->get(marks);
  reader->get(componentOf);
  if (!reader->isWhole()) return fail(ErrorCode::kTruncated, "a piece of the mesh ends early");
  const std::uint32_t first = firstComponent_[piece];
  for (CellId c = 0; c < marks.size(); ++c) {
    if (marks[c] & kDroppedCell) continue;
    if (isTurned_[first + (componentOf.empty() ? 0 : componentOf[c])] != 0) marks[c] ^= kTurnedCell;
  }
  for (auto at =
           std::ranges::lower_bound(found_, static_cast<std::uint32_t>(piece), {}, &Found::piece);
       at != found_.end() && at->piece == piece; ++at)
    marks[at->cell] |= at->mark;
  return marks;
}

}  // namespace qtet
