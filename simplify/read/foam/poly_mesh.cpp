#include "simplify/read/foam/poly_mesh.h"

#include <algorithm>
#include <cassert>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "proto/limits.h"
#include "simplify/mesh/split_mix64.h"
#include "simplify/read/foam/cell_shaper.h"
#include "simplify/read/foam/foam_list.h"
#include "simplify/read/options/grid_parts.h"

namespace qtet {
namespace {

namespace fs = std::filesystem;
using Label = FoamList::Label;

/// A number that looks random for each pair of points.
std::uint64_t hashOf(VertexId a, VertexId b) {
  return SplitMix64(std::uint64_t{a} << 32 ^ b).next();
}

/// Sums up the directed edges of a face. An edge and its reverse give 0 together. So the sum over
/// the faces of a closed cell is 0. That of an open cell is 0 by a chance of 2^-64.
std::uint64_t edgesOf(std::span<const VertexId> corners) {
  std::uint64_t sum = 0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const VertexId a = corners[i], b = corners[i + 1 == corners.size() ? 0 : i + 1];
    if (a != b) sum += a < b ? hashOf(a, b) : std::uint64_t{0} - hashOf(b, a);
  }
  return sum;
}

/// The lists of one folder but for its points.
class MeshFolder {
 public:
  MeshFolder(fs::path folder, std::chrono::seconds patience)
      : folder_(std::move(folder)), patience_(patience) {}

  Status read(std::size_t points) {
    Result<FoamList> faces = open("faces"), owner = open("owner"), neighbour = open("neighbour");
    for (const auto* file : {&faces, &owner, &neighbour})
      if (!*file) return std::unexpected(file->error());
    const auto count = faces->faceCount();
    if (!count) return std::unexpected(count.error());
    for (const auto& [file, into] :
         {std::pair{&*owner, &owner_}, std::pair{&*neighbour, &neighbour_}}) {
      Result<std::vector<Label>> labels = file->labels(*count);
      if (!labels) return std::unexpected(labels.error());
      *into = std::move(*labels);
    }
    if (Status done = countCells(*owner); !done) return done;
    if (Status done = readCorners(*faces, *owner, points); !done) return done;
    if (Status done = checkClosed(*faces); !done) return done;
    return checkBoundary();
  }

  /// The cells with their faces in ascending order.
  void addCellsTo(CellMesh& out) const {
    std::vector<std::size_t> ends(cells_ + 1);
    forEachSide([&](std::size_t cell, std::size_t) { ++ends[cell + 1]; });
    for (std::size_t c = 0; c < cells_; ++c) ends[c + 1] += ends[c];
    std::vector<std::size_t> facesOf(ends[cells_]);
    // each cell's place moves to the end of its faces, where the next cell's begin
    forEachSide([&](std::size_t cell, std::size_t face) { facesOf[ends[cell]++] = face; });
    CellShaper shaper;
    for (std::size_t c = 0, at = 0; c < cells_; ++c) {
      shaper.clear();
      for (; at < ends[c]; ++at)
        shaper.addFace(cornersOf(facesOf[at]), std::cmp_not_equal(owner_[facesOf[at]], c));
      shaper.addTo(out);
    }
  }

 private:
  Result<FoamList> open(const char* name) const {
    return FoamList::open(folder_ / name, patience_);
  }
  [[nodiscard]] bool isInner(std::size_t face) const {
    return face < neighbour_.size() && neighbour_[face] >= 0;
  }
  [[nodiscard]] std::span<const VertexId> cornersOf(std::size_t face) const {
    assert(face < ends_.size());
    const std::size_t begin = face == 0 ? 0 : ends_[face - 1];
    return std::span(corners_).subspan(begin, ends_[face] - begin);
  }
  /// Calls visit(cell, face) for each side of each face, faces ascending.
  template <class Visit>
  void forEachSide(const Visit& visit) const {
    for (std::size_t face = 0; face < owner_.size(); ++face) {
      visit(static_cast<std::size_t>(owner_[face]), face);
      if (isInner(face)) visit(static_cast<std::size_t>(neighbour_[face]), face);
    }
  }

  Status countCells(const FoamList& file) {
    Label last = -1;
    for (const Label cell : owner_) last = std::max(last, cell);
    for (const Label cell : neighbour_) last = std::max(last, cell);
    cells_ = static_cast<std::size_t>(last + 1);
    if (cells_ <= owner_.size()) return {};
    return file.bad("a cell has number " + std::to_string(last) + ", but there are only " +
                    std::to_string(owner_.size()) + " faces");
  }

  Status readCorners(FoamList& file, const FoamList& owner, std::size_t points) {
    const Status done = file.faces([&](std::span<const Label> corners) -> Status {
      const std::string face = "face " + std::to_string(ends_.size());
      if (ends_.size() >= owner_.size())
        return owner.bad("it has fewer lines than there are faces");
      if (corners.size() < 3) return file.badHere(face + " has fewer than three corners");
      for (const Label v : corners) {
        if (v < 0 || std::cmp_greater_equal(v, points))
          return file.badHere(face + " has a corner " + std::to_string(v) +
                              " that is none of the " + std::to_string(points) + " points");
        corners_.push_back(narrowedId(v));
      }
      if (owner_[ends_.size()] < 0) return owner.bad(face + " has no cell");
      if (isInner(ends_.size()) && neighbour_[ends_.size()] == owner_[ends_.size()])
        return owner.bad(face + " lies between a cell and itself");
      ends_.push_back(corners_.size());
      return {};
    });
    if (!done || (ends_.size() == owner_.size() && neighbour_.size() <= ends_.size())) return done;
    return file.bad("it has " + std::to_string(ends_.size()) + " faces, but owner has " +
                    std::to_string(owner_.size()) + " lines and neighbour " +
                    std::to_string(neighbour_.size()));
  }

  [[nodiscard]] Status checkClosed(const FoamList& file) const {
    assert(ends_.size() == owner_.size() && neighbour_.size() <= owner_.size());
    std::vector<std::uint64_t> open(cells_);
    for (std::size_t face = 0; face < owner_.size(); ++face) {
      const std::uint64_t edges = edgesOf(cornersOf(face));
      open[static_cast<std::size_t>(owner_[face])] += edges;
      if (isInner(face)) open[static_cast<std::size_t>(neighbour_[face])] -= edges;
    }
    const auto isOpen = [](std::uint64_t sum) { return sum != 0; };
    const auto torn = std::ranges::find_if(open, isOpen);
    if (torn == open.end()) return {};
    return file.bad("the faces of " + std::to_string(std::ranges::count_if(open, isOpen)) +
                    " cells do not close, first those of cell " +
                    std::to_string(torn - open.begin()) +
                    ": lines of faces, owner or neighbour are wrong");
  }

  [[nodiscard]] Status checkBoundary() const {
    Result<FoamList> file = open("boundary");
    if (!file) return std::unexpected(file.error());
    const auto patches = file->patchFaces();
    if (!patches) return std::unexpected(patches.error());
    std::uint64_t outer = 0;
    for (std::size_t face = 0; face < owner_.size(); ++face) outer += isInner(face) ? 0 : 1;
    if (*patches == outer) return {};
    return file->bad("its patches have " + std::to_string(*patches) + " faces, but the mesh has " +
                     std::to_string(outer) + " at its boundary");
  }

  fs::path folder_;
  std::chrono::seconds patience_;
  std::vector<std::size_t> ends_;  ///< behind each face's corners
  std::vector<VertexId> corners_;
  std::vector<Label> owner_, neighbour_;  ///< each face's cells; -1 or nothing: the boundary
  std::size_t cells_ = 0;
};

}  // namespace

Status readFoamPoints(const fs::path& folder, std::chrono::seconds patience, CellMesh& out) {
  Result<FoamList> file = FoamList::open(folder / "points", patience);
  if (!file) return std::unexpected(file.error());
  const auto numbers = file->tuples(3, std::nullopt);
  if (!numbers) return std::unexpected(numbers.error());
  out.pointType = file->realType();
  out.points.resize(numbers->size() / 3);
  for (std::size_t i = 0; i < numbers->size(); ++i) out.points[i / 3][i % 3] = (*numbers)[i];
  return {};
}

Status readPolyMesh(const fs::path& folder, std::chrono::seconds patience, CellMesh& out) {
  MeshFolder mesh(folder, patience);
  if (Status done = mesh.read(out.points.size()); !done) return done;
  mesh.addCellsTo(out);
  return {};
}

void addCellZones(const fs::path& folder, std::chrono::seconds patience, CellMesh& out,
                  std::vector<std::string>& notes) {
  if (!FoamList::isThere(folder / "cellZones")) return;
  CellLabel label{kZoneLabel, std::vector<std::int32_t>(out.cells()), {}};
  std::int32_t number = 0;
  std::uint64_t twice = 0;
  const auto read = [&]() -> Status {
    Result<FoamList> file = FoamList::open(folder / "cellZones", patience);
    if (!file) return std::unexpected(file.error());
    return file->zones(out.cells(),
                       [&](std::string_view name, std::span<const Label> cells) -> Status {
                         ++number;
                         if (label.names.size() < kMaxLabelNames) label.names.emplace(number, name);
                         for (const Label cell : cells) {
                           if (cell < 0 || std::cmp_greater_equal(cell, label.values.size()))
                             return file->badHere("zone " + std::string(name) + " has a cell " +
                                                  std::to_string(cell) + " that is none of the " +
                                                  std::to_string(label.values.size()) + " cells");
                           std::int32_t& zone = label.values[static_cast<std::size_t>(cell)];
                           if (zone != 0) ++twice;
                           if (zone == 0) zone = number;
                         }
                         return {};
                       });
  };
  if (const Status done = read(); !done) {
    notes.push_back("zones of cells were left out: " + done.error().message);
    return;
  }
  if (label.names.empty()) return;
  if (twice > 0)
    notes.push_back(std::to_string(twice) + " cells are in two zones of " +
                    (folder / "cellZones").string() + ", and count to the first");
  out.labels.push_back(std::move(label));
}

}  // namespace qtet
