#include "simplify/read/pieces/vtu_pieces.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "simplify/read/options/grid_parts.h"
#include "simplify/read/options/mesh_format.h"
#include "simplify/read/options/select_fields.h"
#include "simplify/read/options/time_steps.h"
#include "simplify/read/parts/named_files.h"
#include "simplify/read/vtu/old_hexahedra.h"
#include "simplify/read/vtu/read_vtu.h"
#include "simplify/read/vtu/vtu_cells.h"
#include "simplify/read/vtu/vtu_label_names.h"
#include "simplify/read/vtu/vtu_ranges.h"
#include "simplify/series/series.h"
#include "simplify/split/split_cells.h"

namespace qtet {
namespace {

/// Points that are read and written at once: some MB.
constexpr std::uint64_t kPointsAtOnce = 65536;

bool isText(const VtuDocument& document) {
  const auto isAscii = [](const VtuArray& array) { return array.place == VtuArray::Place::kAscii; };
  return std::ranges::any_of(document.pieces, [&](const VtuPiece& piece) {
    return (piece.coordinates && isAscii(*piece.coordinates)) ||
           std::ranges::any_of(piece.cellArrays, isAscii) ||
           std::ranges::any_of(piece.pointFields.arrays, isAscii) ||
           std::ranges::any_of(piece.cellFields.arrays, isAscii);
  });
}

/// An option that takes the whole mesh, or nothing.
std::string whatTakesAll(const ReadOptions& options) {
  if (options.weld) return "`weld`";
  if (options.threshold) return "`threshold`";
  if (options.originalIds) return "`originalIds`";
  if (!options.listed.files.empty()) return "a series of files";
  if (options.plot3d) return "a PLOT3D grid";
  return {};
}

const VtuFields& fieldsIn(const VtuPiece& piece, const MeshField& shape) {
  return isCellField(shape) ? piece.cellFields : piece.pointFields;
}

Status areNarrow(const MeshField& field, const std::filesystem::path& path) {
  constexpr double kFirstInexactInteger = 0x1p53;
  if (field.type != "int64" && field.type != "uint64") return {};
  const bool isWide = std::ranges::any_of(
      field.values, [](double value) { return std::abs(value) >= kFirstInexactInteger; });
  if (!isWide) return {};
  return fail(ErrorCode::kBadInput, path.string() + ": " + field.association + " field " +
                                        field.name +
                                        " holds an integer of 2^53 or more; leave the field out "
                                        "of `fields`");
}

}  // namespace

Result<std::unique_ptr<VtuPieces>> VtuPieces::open(const std::filesystem::path& path,
                                                   const ReadOptions& options, std::string& why) {
  const MeshFormat format = options.format.empty() && path.extension() != ".gz"
                                ? formatOfContent(path, formatOf(path))
                                : formatOf("mesh." + options.format);
  if (format != MeshFormat::kVtu && format != MeshFormat::kPvtu) {
    why = "only .vtu and .pvtu are read in pieces";
    return nullptr;
  }
  if (why = whatTakesAll(options); !why.empty()) {
    why += " takes the whole mesh";
    return nullptr;
  }
  if (Status s = checkMeshFile(path, format); !s) return std::unexpected(s.error());
  std::unique_ptr<VtuPieces> out(new VtuPieces(path, options));
  std::vector<std::filesystem::path> files{path};
  if (format == MeshFormat::kPvtu) {
    const auto pieces = piecesOf(path, format);
    if (!pieces) return std::unexpected(pieces.error());
    files.clear();
    for (const BlockFile& piece : *pieces) files.push_back(piece.path);
  }
  for (const std::filesystem::path& file : files) {
    if (format == MeshFormat::kPvtu)
      if (Status s = checkMeshFile(file, MeshFormat::kVtu); !s)
        return fail(s.error().code, path.string() + " names it: " + s.error().message);
    if (Status s = out->addFile(file); !s) return std::unexpected(s.error());
    const VtuDocument& document = out->files_.back()->document;
    if (document.hasTimeSteps || document.kind != GridKind::kUnstructured) {
      why = "it has time steps or is no unstructured grid";
      return nullptr;
    }
    if (isText(document)) {
      why = "its numbers are text, of which no range can be read alone";
      return nullptr;
    }
  }
  if (out->parts_.empty()) {
    why = "it has no cells";
    return nullptr;
  }
  return out;
}

Status VtuPieces::addFile(const std::filesystem::path& path) {
  Result<VtuFile> file = VtuFile::open(path, options_.patience);
  if (!file) return std::unexpected(file.error());
  Result<VtuDocument> document = readVtuDocument(*file);
  if (!document) return std::unexpected(document.error());
  files_.push_back(std::make_unique<File>(path, std::move(*document)));
  const File& own = *files_.back();
  for (const VtuPiece& piece : own.document.pieces) {
    if (piece.cells == 0) continue;
    if (__builtin_add_overflow(cells_, piece.cells, &cells_) || piece.points >= kGhost)
      return fail(ErrorCode::kLimitExceeded,
                  path.string() + ": a piece of the file has 2^32 points or more; cut it");
    parts_.push_back({&own, &piece, points_});
    points_ += piece.points;
  }
  return {};
}

Status VtuPieces::open(const Part& part) {
  if (opened_ == part.file) return {};
  Result<VtuFile> file = VtuFile::open(part.file->path, options_.patience);
  if (!file) return std::unexpected(file.error());
  open_.emplace(std::move(*file));
  opened_ = part.file;
  return {};
}

Status VtuPieces::begin(const MakeSpool& spool, std::size_t pieceCells) {
  pieceCells_ = pieceCells;
  report_.pieces = parts_.size();
  if (const auto steps = chosenSteps({}, options_.time, path_, report_.notes); !steps)
    return std::unexpected(steps.error());
  if (Status s = choose(); !s) return s;
  std::size_t values = 0;
  for (const Chosen& field : fields_)
    if (!isCellField(field.shape)) values += field.shape.components;
  Result<std::unique_ptr<ByteSpool>> made =
      spool ? spool() : Result<std::unique_ptr<ByteSpool>>(std::make_unique<MemorySpool>());
  if (!made) return std::unexpected(made.error());
  records_.emplace(std::move(*made), values);
  for (const Part& part : parts_)
    if (Status s = spoolPoints(part); !s) return s;
  return {};
}

/// Chooses the fields by the first part, as readMesh does by all. A field of numbers is one whose
/// first values are.
Status VtuPieces::choose() {
  const Part& first = parts_.front();
  if (Status s = open(first); !s) return s;
  FieldChoice choice(options_.fields, report_);
  CellMesh few;
  const auto add = [&](const VtuFields& from, const char* association) {
    int number = 0;
    for (const VtuArray& array : from.arrays) {
      if (&array != &*std::ranges::find(from.arrays, array.name, &VtuArray::name)) continue;
      const auto name = choice.nameOf({array.name, number++, array.components,
                                       array.type != VtuNumber::kText, isOfTheShape(from, array)},
                                      association, few);
      if (!name) continue;
      fields_.push_back({array.name,
                         {.name = *name,
                          .components = array.components,
                          .type = fieldTypeOf(array),
                          .values = {},
                          .association = association}});
    }
  };
  add(first.piece->pointFields, "point");
  add(first.piece->cellFields, "cell");
  for (Chosen& field : fields_) {
    const Result<const VtuArray*> array = arrayOf(first, field);
    if (!array) return std::unexpected(array.error());
    const std::uint64_t tuples =
        isCellField(field.shape) ? first.piece->cells : first.piece->points;
    Result<std::vector<double>> values =
        readVtuValueRange(*open_, first.file->document, **array, tuples,
                          {0, std::min<std::uint64_t>(tuples, kPointsAtOnce)});
    if (!values) return std::unexpected(values.error());
    few.fields.push_back(field.shape);
    few.fields.back().values = std::move(*values);
  }
  nameFields(few.fields, report_.notes);
  for (std::size_t f = 0; f < fields_.size(); ++f) fields_[f].shape.name = few.fields[f].name;
  if (Status s = readVtuLabelNames(*open_, first.file->document, few); !s) return s;
  for (std::size_t f = 0; f < fields_.size(); ++f)
    fields_[f].shape.labelNames = few.fields[f].labelNames;
  if (!options_.keepsNumbers) leaveOutNumbers(options_.fields, few, report_.notes);
  if (Status s = selectFields(options_.fields, path_, few.otherFields, few.fields); !s) return s;
  putInOrder(seriesOrder(few.fields), few.fields);
  std::vector<Chosen> chosen;
  for (const MeshField& field : few.fields)
    chosen.push_back(*std::ranges::find_if(fields_, [&](const Chosen& one) {
      return one.shape.name == field.name && one.shape.association == field.association;
    }));
  fields_ = std::move(chosen);
  pointType_ = first.piece->coordinates && first.piece->coordinates->type == VtuNumber::kFloat32
                   ? "float32"
                   : "float64";
  return {};
}

Result<const VtuArray*> VtuPieces::arrayOf(const Part& part, const Chosen& field) const {
  const std::vector<VtuArray>& arrays = fieldsIn(*part.piece, field.shape).arrays;
  const auto at = std::ranges::find(arrays, field.array, &VtuArray::name);
  if (at == arrays.end())
    return open_->bad("line " + std::to_string(part.piece->line) + ": a <Piece> has no array " +
                      field.array + ", which the first piece has; export the mesh again");
  if (fieldTypeOf(*at) != field.shape.type || at->components != field.shape.components)
    return open_->bad(at->called() +
                      " has another type or number of components than in the first piece; export "
                      "the mesh again");
  return &*at;
}

Status VtuPieces::spoolPoints(const Part& part) {
  const File& from = *part.file;
  if (Status s = open(part); !s) return s;
  for (std::uint64_t first = 0; first < part.piece->points; first += kPointsAtOnce) {
    const VtuRange range{first, std::min(kPointsAtOnce, part.piece->points - first)};
    const auto points = readVtuPointRange(*open_, from.document, *part.piece, range);
    if (!points) return std::unexpected(points.error());
    std::vector<double> records(range.count * records_->width());
    for (std::size_t i = 0; i < range.count; ++i)
      std::ranges::copy((*points)[i], &records[i * records_->width()]);
    std::size_t column = 3;
    for (const Chosen& field : fields_) {
      if (isCellField(field.shape)) continue;
      const Result<const VtuArray*> array = arrayOf(part, field);
      if (!array) return std::unexpected(array.error());
      const std::size_t n = field.shape.components;
      MeshField values = field.shape;
      Result<std::vector<double>> some =
          readVtuValueRange(*open_, from.document, **array, part.piece->points, range);
      if (!some) return std::unexpected(some.error());
      values.values = std::move(*some);
      if (Status s = areNarrow(values, path_); !s) return s;
      for (std::size_t i = 0; i < range.count; ++i)
        std::copy_n(&values.values[i * n], n, &records[i * records_->width() + column]);
      column += n;
    }
    if (Status s = records_->append(records); !s) return s;
  }
  return {};
}

Result<std::optional<InputPiece>> VtuPieces::next() {
  while (part_ < parts_.size()) {
    const Part& part = parts_[part_];
    if (Status s = open(part); !s) return std::unexpected(s.error());
    if (nextCell_ == 0) {
      Result<std::vector<bool>> hidden = hiddenCells(*open_, part.file->document, *part.piece);
      if (!hidden) return std::unexpected(hidden.error());
      hidden_ = std::move(*hidden);
    }
    const std::uint64_t first = nextCell_,
                        count = std::min<std::uint64_t>(pieceCells_, part.piece->cells - first);
    nextCell_ += count;
    const auto number = part_;
    if (nextCell_ == part.piece->cells) ++part_, nextCell_ = 0;
    Result<CellMesh> cells = cellsOf(part, first, count);
    if (!cells) return std::unexpected(cells.error());
    if (cells->cells() == 0) continue;
    Result<InputPiece> out = pieceOf(std::move(*cells));
    if (!out) return std::unexpected(out.error());
    out->part = number;
    return std::optional(std::move(*out));
  }
  records_.reset();
  open_.reset(), opened_ = nullptr;
  hidden_ = {};
  if (report_.ignoredCells > 0)
    report_.notes.push_back(std::to_string(report_.ignoredCells) +
                            " points, lines and faces among the cells were ignored");
  return std::nullopt;
}

/// The visible volume cells of the range, with their points.
Result<CellMesh> VtuPieces::cellsOf(const Part& part, std::uint64_t first, std::uint64_t count) {
  const File& from = *part.file;
  Result<CellMesh> all = readVtuCellRange(*open_, from.document, *part.piece, {first, count});
  if (!all) return all;
  CellMesh out;
  std::vector<std::uint64_t> rows;
  for (std::size_t i = 0; i < all->cells(); ++i) {
    if (!hidden_.empty() && hidden_[first + i]) continue;
    if (dimensionOf(all->types[i]) < 3) {
      ++report_.ignoredCells;
      continue;
    }
    out.addCell(all->types[i], all->cell(i));
    out.cellIds.push_back(all->cellId(i));
    rows.push_back(i);
  }
  if (out.cells() == 0) return out;
  if (Status s = takePoints(part, out); !s) return std::unexpected(s.error());
  if (Status s = takeValues(part, first, count, rows, out); !s) return std::unexpected(s.error());
  if (from.document.hasOldHexahedra) renumberOldHexahedra(out);
  if (Status s = checkCellMesh(out, from.path); !s) return std::unexpected(s.error());
  return out;
}

Status VtuPieces::takePoints(const Part& part, CellMesh& cells) {
  names_.clear();
  for (std::size_t i = 0; i < cells.cells(); ++i)
    for (const VertexId v : cells.cell(i)) {
      if (v == kGhost) return open_->bad(verticesOutside(cells.cellId(i)));
      names_.push_back(part.firstPoint + v);
    }
  std::ranges::sort(names_);
  const auto repeated = std::ranges::unique(names_);
  names_.erase(repeated.begin(), repeated.end());
  for (VertexId& v : cells.vertices)
    v = static_cast<VertexId>(std::ranges::lower_bound(names_, part.firstPoint + v) -
                              names_.begin());
  cells.pointType = pointType_;
  cells.points.resize(names_.size());
  for (const Chosen& field : fields_) {
    cells.fields.push_back(field.shape);
    if (!isCellField(field.shape))
      cells.fields.back().values.resize(names_.size() * field.shape.components);
  }
  return records_->fetch(names_, [&](std::size_t i, std::span<const double> record) {
    std::copy_n(record.begin(), 3, cells.points[i].begin());
    std::size_t column = 3;
    for (MeshField& field : cells.fields) {
      if (isCellField(field)) continue;
      std::copy_n(&record[column], field.components, &field.values[i * field.components]);
      column += field.components;
    }
  });
}

Status VtuPieces::takeValues(const Part& part, std::uint64_t first, std::uint64_t count,
                             const std::vector<std::uint64_t>& rows, CellMesh& cells) const {
  for (std::size_t f = 0; f < fields_.size(); ++f) {
    if (!isCellField(fields_[f].shape)) continue;
    const Result<const VtuArray*> array = arrayOf(part, fields_[f]);
    if (!array) return std::unexpected(array.error());
    Result<std::vector<double>> values =
        readVtuValueRange(*open_, part.file->document, **array, part.piece->cells, {first, count});
    if (!values) return std::unexpected(values.error());
    cells.fields[f].values = std::move(*values);
    if (rows.size() < count) keepRows(cells.fields[f], rows);
    if (Status s = areNarrow(cells.fields[f], path_); !s) return s;
  }
  return {};
}

/// Splits the cells.
Result<InputPiece> VtuPieces::pieceOf(CellMesh&& cells) {
  const bool areTetrahedra =
      std::ranges::all_of(cells.types, [](std::uint8_t type) { return type == kTetrahedronCell; });
  if (!areTetrahedra && parts_.size() > 1)
    return open_->bad(
        "it has cells that are no tetrahedra, and the mesh has several pieces; where these meet, "
        "cells are split with the whole mesh at hand: leave out `memory`, or convert it to "
        "tetrahedra");
  InputPiece out;
  out.vertices = names_;
  Result<TetMesh> mesh = splitCells(std::move(cells), {options_.curved, false}, report_.split);
  if (!mesh) return fail(mesh.error().code, path_.string() + ": " + mesh.error().message);
  while (out.vertices.size() < mesh->points.size()) out.vertices.push_back(points_ + added_++);
  out.mesh = std::move(*mesh);
  out.firstCell = tetrahedra_;
  tetrahedra_ += out.mesh.tetrahedra.size();
  return out;
}

}  // namespace qtet
