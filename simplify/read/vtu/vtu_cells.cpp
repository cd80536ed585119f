#include "simplify/read/vtu/vtu_cells.h"

#include <algorithm>
#include <cassert>
#include <ranges>
#include <span>
#include <string_view>

#include "simplify/read/options/grid_parts.h"
#include "simplify/read/vtu/vtu_numbers.h"

namespace qtet {
namespace {

Result<std::vector<std::int64_t>> wholeArray(const VtuFile& file, const VtuDocument& document,
                                             const VtuArray& from, std::uint64_t told) {
  const auto certain = certainNumbers(file, document, from, told);
  if (!certain) return std::unexpected(certain.error());
  std::vector<std::int64_t> out;
  out.reserve(*certain);
  const Status done = readIntegers(file, document, from, {told, 0, told}, [&](auto numbers) {
    out.insert(out.end(), numbers.begin(), numbers.end());
  });
  if (!done) return std::unexpected(done.error());
  return out;
}

/// Takes a piece's list of vertices, a batch at a time, and makes its cells of it.
class CellIntake {
 public:
  CellIntake(const VtuFile& file, const VtuDocument& document, const VtuPiece& piece,
             std::uint64_t firstPoint)
      : file_(file), document_(document), piece_(piece), firstPoint_(firstPoint) {}

  Status read(CellMesh& out, KeptRows& rows, ReadReport& report) {
    if (Status done = readTypes(); !done) return done;
    Result<std::vector<bool>> hidden = hiddenCells(file_, document_, piece_);
    if (!hidden) return std::unexpected(hidden.error());
    hidden_ = std::move(*hidden);
    if (Status done = readEnds(); !done) return done;
    if (std::ranges::find(types_, kPolyhedronCell) != types_.end()) {
      if (Status done = readFaces(); !done) return done;
    }
    out_ = &out;
    rows_ = &rows;
    report_ = &report;
    out.types.reserve(out.types.size() + types_.size());
    out.begins.reserve(out.begins.size() + types_.size());
    if (areAllAlike()) return readAlike();
    if (!ends_.empty() && ends_.back() > 0) {
      if (Status done = readVertices([&](auto ids) { take(ids); }); !done) return done;
    }
    while (cell_ < types_.size() && status_) close();
    return status_;
  }

 private:
  [[nodiscard]] const VtuArray* find(std::string_view name) const {
    const auto at = std::ranges::find(piece_.cellArrays, name, &VtuArray::name);
    return at == piece_.cellArrays.end() ? nullptr : &*at;
  }

  /// The array of <Cells> with that name, which must be there.
  Result<const VtuArray*> array(const char* name) const {
    const VtuArray* found = find(name);
    const std::string piece = "line " + std::to_string(piece_.line) + ": a <Piece> ";
    if (!found)
      return file_.bad(piece + "has cells, but no array " + name +
                       " in <Cells>; the file is damaged, export it again");
    if (found->components != 1)
      return file_.bad(found->called() + " has " + std::to_string(found->components) +
                       " components, not one; the file is damaged, export it again");
    return found;
  }

  /// All numbers of an array of <Cells>, of which `told` must be there.
  Result<std::vector<std::int64_t>> integers(const char* name, std::uint64_t told) const {
    const auto from = array(name);
    if (!from) return std::unexpected(from.error());
    return wholeArray(file_, document_, **from, told);
  }
  Status readTypes() {
    const auto from = array("types");
    if (!from) return std::unexpected(from.error());
    const auto certain = certainNumbers(file_, document_, **from, piece_.cells);
    if (!certain) return std::unexpected(certain.error());
    types_.reserve(*certain);
    std::uint64_t wrong = 0, first = 0;
    const Status done =
        readIntegers(file_, document_, **from, {piece_.cells, 0, piece_.cells}, [&](auto numbers) {
          for (const std::int64_t type : numbers) {
            if ((type < 0 || type > 255) && wrong++ == 0) first = types_.size();
            types_.push_back(static_cast<std::uint8_t>(type));
          }
        });
    if (!done || wrong == 0) return done;
    return file_.bad((*from)->called() + ": cell " + std::to_string(first) +
                     " has a type that is not 0 to 255; the file is damaged, export it again");
  }

  Status readEnds() {
    Result<std::vector<std::int64_t>> ends = integers("offsets", piece_.cells);
    if (!ends) return std::unexpected(ends.error());
    ends_ = std::move(*ends);
    std::int64_t last = 0;
    for (std::size_t i = 0; i < ends_.size(); last = ends_[i++])
      if (ends_[i] < last) return file_.bad(verticesOutside(i));
    return {};
  }

  /// The faces of each polyhedron one behind the other, as `faces` has them. Newer files list the
  /// mesh's faces once, and name those of each polyhedron.
  Status readFaces() {
    if (!find("faces") && find("polyhedron_to_faces")) return readSharedFaces();
    if (!find("faces") || !find("faceoffsets")) return {};
    Result<std::vector<std::int64_t>> ends = integers("faceoffsets", piece_.cells);
    if (!ends) return std::unexpected(ends.error());
    const auto last = std::find_if(ends->rbegin(), ends->rend(), [](auto end) { return end >= 0; });
    const std::int64_t told = last == ends->rend() ? 0 : *last;
    Result<std::vector<std::int64_t>> faces = integers("faces", static_cast<std::uint64_t>(told));
    if (!faces) return std::unexpected(faces.error());
    faces_ = std::move(*faces);
    for (const std::int64_t end : *ends) hasFaces_.push_back(end >= 0);
    return {};
  }

  /// As readFaces, from face_connectivity, face_offsets, polyhedron_to_faces, polyhedron_offsets.
  Status readSharedFaces() {
    const auto ends = integers("polyhedron_offsets", piece_.cells);
    if (!ends) return std::unexpected(ends.error());
    const auto faceIds = integers("polyhedron_to_faces", lastOf(*ends));
    if (!faceIds) return std::unexpected(faceIds.error());
    const std::int64_t faces = faceIds->empty() ? 0 : std::ranges::max(*faceIds);
    if (faces < 0 || faces == INT64_MAX) return contradicted();
    const auto faceEnds = integers("face_offsets", static_cast<std::uint64_t>(faces) + 1);
    if (!faceEnds) return std::unexpected(faceEnds.error());
    const auto corners = integers("face_connectivity", lastOf(*faceEnds));
    if (!corners) return std::unexpected(corners.error());
    std::int64_t begin = 0;
    for (const std::int64_t end : *ends) {
      if (end < begin || static_cast<std::uint64_t>(end) > faceIds->size()) return contradicted();
      hasFaces_.push_back(end > begin);
      if (end > begin) faces_.push_back(end - begin);
      for (; begin < end; ++begin) {
        const auto face = static_cast<std::size_t>((*faceIds)[static_cast<std::size_t>(begin)]);
        if (face >= faceEnds->size()) return contradicted();
        const std::int64_t from = face == 0 ? 0 : (*faceEnds)[face - 1], to = (*faceEnds)[face];
        if (from < 0 || to < from || static_cast<std::uint64_t>(to) > corners->size())
          return contradicted();
        faces_.push_back(to - from);
        faces_.insert(faces_.end(), corners->begin() + from, corners->begin() + to);
      }
    }
    return {};
  }
  static std::uint64_t lastOf(const std::vector<std::int64_t>& ends) {
    return ends.empty() || ends.back() < 0 ? 0 : static_cast<std::uint64_t>(ends.back());
  }
  [[nodiscard]] Status contradicted() const {
    return file_.bad("line " + std::to_string(piece_.line) +
                     ": the arrays of polyhedra in <Cells> contradict each other; the file is "
                     "damaged, export it again");
  }

  Status readVertices(const TakeNumbers<std::int64_t>& taking) {
    const auto from = array("connectivity");
    if (!from) return std::unexpected(from.error());
    const auto told = static_cast<std::uint64_t>(ends_.back());
    const auto certain = certainNumbers(file_, document_, **from, told);
    if (!certain) return std::unexpected(certain.error());
    out_->vertices.reserve(out_->vertices.size() + *certain);
    return readIntegers(file_, document_, **from, {told, 0, told}, taking);
  }

  /// Whether all cells are kept, of one kind and of one number of vertices, one behind the other.
  [[nodiscard]] bool areAllAlike() const {
    if (types_.empty() || !hidden_.empty() || !hasFaces_.empty() || !isKept(0)) return false;
    const std::uint8_t type = types_.front();
    const std::int64_t vertices = ends_.front();
    const auto cells = static_cast<std::int64_t>(ends_.size());
    if (vertices <= 0 || vertices > INT64_MAX / cells || type == kPolyhedronCell) return false;
    std::int64_t end = 0;
    return std::ranges::all_of(types_, [&](std::uint8_t t) { return t == type; }) &&
           std::ranges::all_of(ends_, [&](std::int64_t e) { return e == (end += vertices); });
  }

  /// The same as readVertices and close of each cell, in bulk.
  Status readAlike() {
    assert(ends_.size() == types_.size());
    const std::uint64_t first = out_->vertices.size();
    const Status done = readVertices([&](std::span<const std::int64_t> ids) {
      const auto names = ids | std::views::transform([this](auto id) { return shifted(id); });
      out_->vertices.insert(out_->vertices.end(), names.begin(), names.end());
    });
    if (!done) return done;
    out_->types.insert(out_->types.end(), types_.begin(), types_.end());
    for (const std::int64_t end : ends_)
      out_->begins.push_back(first + static_cast<std::uint64_t>(end));
    rows_->keep(types_.size());
    return {};
  }

  void take(std::span<const std::int64_t> ids) {
    while (!ids.empty() && status_) {
      while (cell_ < types_.size() && at_ == ends_[cell_] && status_) close();
      if (cell_ == types_.size() || !status_) return;
      assert(at_ < ends_[cell_]);
      const auto count = static_cast<std::size_t>(
          std::min<std::int64_t>(ends_[cell_] - at_, static_cast<std::int64_t>(ids.size())));
      if (isKept(cell_) && types_[cell_] != kPolyhedronCell)
        for (const std::int64_t id : ids.first(count)) out_->vertices.push_back(shifted(id));
      ids = ids.subspan(count);
      at_ += static_cast<std::int64_t>(count);
    }
  }

  [[nodiscard]] bool isKept(std::size_t cell) const {
    return dimensionOf(types_[cell]) == 3 && (hidden_.empty() || !hidden_[cell]);
  }

  /// An id beyond the piece's points is none.
  [[nodiscard]] VertexId shifted(std::int64_t id) const {
    if (id < 0 || static_cast<std::uint64_t>(id) >= piece_.points) return kGhost;
    return narrowedId(id + static_cast<std::int64_t>(firstPoint_));
  }

  /// Ends the present cell, whose vertices are there.
  void close() {
    assert(cell_ < types_.size());
    const std::uint8_t type = types_[cell_];
    const bool isVolume = dimensionOf(type) == 3, kept = isKept(cell_);
    if (!isVolume) ++report_->ignoredCells;
    const std::size_t faces = facesAt_;
    if (cell_ < hasFaces_.size() && hasFaces_[cell_]) skipFaces();
    if (kept) {
      if (type == kPolyhedronCell) addPolyhedron(faces);
      out_->types.push_back(type);
      out_->begins.push_back(out_->vertices.size());
      rows_->keep();
    } else {
      rows_->drop();
    }
    ++cell_;
  }

  void skipFaces() {
    const auto damaged = [&] { status_ = file_.bad(withoutFaces(rows_->next())); };
    if (facesAt_ >= faces_.size()) return damaged();
    for (std::int64_t left = faces_[facesAt_++]; left > 0; --left) {
      if (facesAt_ >= faces_.size() || faces_[facesAt_] < 0 ||
          static_cast<std::uint64_t>(faces_[facesAt_]) >= faces_.size() - facesAt_)
        return damaged();
      facesAt_ += 1 + static_cast<std::size_t>(faces_[facesAt_]);
    }
  }

  void addPolyhedron(std::size_t at) {
    const std::size_t first = out_->vertices.size();
    if (cell_ >= hasFaces_.size() || !hasFaces_[cell_] || !appendFaces(faces_, at, *out_)) {
      if (status_) status_ = file_.bad(withoutFaces(rows_->next()));
      return;
    }
    forEachId(kPolyhedronCell, std::span(out_->vertices).subspan(first),
              [&](VertexId& v) { v = v == kGhost ? v : shifted(static_cast<std::int64_t>(v)); });
  }

  const VtuFile& file_;
  const VtuDocument& document_;
  const VtuPiece& piece_;
  std::uint64_t firstPoint_;
  CellMesh* out_ = nullptr;
  KeptRows* rows_ = nullptr;
  ReadReport* report_ = nullptr;

  std::vector<std::uint8_t> types_;
  std::vector<bool> hidden_;            ///< empty: none is
  std::vector<std::int64_t> ends_;      ///< of each cell's vertices
  std::vector<std::int64_t> faces_;     ///< of all polyhedra, as appendFaces takes them
  std::vector<bool> hasFaces_;          ///< by cell; empty: none has
  std::size_t cell_ = 0, facesAt_ = 0;  ///< the present cell, and where its faces begin
  std::int64_t at_ = 0;                 ///< vertices taken
  Status status_;
};

}  // namespace

Result<std::vector<bool>> hiddenCells(const VtuFile& file, const VtuDocument& document,
                                      const VtuPiece& piece) {
  std::vector<bool> hidden;
  for (const VtuArray& from : piece.cellFields.arrays) {
    const bool isLevels = from.name == kGhostLevels;
    const bool isTypes = from.name == kGhostTypes && from.type == VtuNumber::kUInt8;
    if ((!isLevels && !isTypes) || bytesOf(from.type) == 0) continue;
    const auto numbers = wholeArray(file, document, from, piece.cells * from.components);
    if (!numbers) return std::unexpected(numbers.error());
    hidden.resize(piece.cells);
    for (std::size_t i = 0; i < hidden.size(); ++i) {
      const std::int64_t mark = (*numbers)[i * from.components];
      if (isLevels ? mark > 0 : (static_cast<std::uint64_t>(mark) & kElsewhere) != 0)
        hidden[i] = true;
    }
  }
  return hidden;
}

Status readVtuCells(const VtuFile& file, const VtuDocument& document, const VtuPiece& piece,
                    std::uint64_t firstPoint, CellMesh& out, KeptRows& rows, ReadReport& report) {
  if (piece.cells == 0) return {};
  return CellIntake(file, document, piece, firstPoint).read(out, rows, report);
}

}  // namespace qtet
