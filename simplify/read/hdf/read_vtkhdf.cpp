#include "simplify/read/hdf/read_vtkhdf.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "simplify/read/options/grid_parts.h"

namespace qtet {
namespace {

constexpr const char* kRoot = "VTKHDF";
std::string under(const std::string& name) { return std::string(kRoot) + "/" + name; }

/// The parts of a file that differ between fields of points and of cells.
struct Association {
  const char* name;
  const char* group;
};
constexpr Association kOfPoints{"point", "PointData"}, kOfCells{"cell", "CellData"};

/// Reads the partitions of one step.
class StepReader {
 public:
  StepReader(const HdfFile& file, std::optional<std::size_t> step, const FieldNames& wanted,
             ReadReport& report)
      : file_(file), step_(step), wanted_(wanted), report_(report) {}

  Result<std::vector<CellMesh>> read() {
    if (Status done = readCounts(); !done) return std::unexpected(done.error());
    if (Status done = chooseFields(); !done) return std::unexpected(done.error());
    std::vector<CellMesh> out;
    for (partition_ = 0; partition_ < counts_.size(); ++partition_) {
      Result<CellMesh> mesh = readPartition();
      if (!mesh) return std::unexpected(mesh.error());
      out.push_back(std::move(*mesh));
      const Counts& read = counts_[partition_];
      point_ += read.points, cell_ += read.cells, corner_ += read.corners;
    }
    return out;
  }

 private:
  struct Counts {
    std::uint64_t points, cells, corners;
  };
  /// An array that becomes a field. Its rows of the step begin `shift` behind those of the mesh,
  /// modulo 2^64.
  struct Field {
    HdfArray array;
    const Association* of;
    std::string name;
    std::uint64_t shift = 0;
  };

  /// A row of the group Steps: the number for this step. `missing` where there is no such array.
  Result<std::uint64_t> atStep(const std::string& name, std::optional<std::uint64_t> missing) {
    const std::string path = under("Steps/" + name);
    if (!step_ || (missing && !file_.has(path))) return missing.value_or(0);
    const auto array = file_.array(path);
    if (!array) return std::unexpected(array.error());
    const auto numbers = file_.integers(*array, *step_, 1);
    if (!numbers) return std::unexpected(numbers.error());
    if (numbers->empty() || numbers->front() < 0)
      return file_.bad("its array " + path + " has no number from 0 on for step " +
                       std::to_string(*step_) + "; export the mesh again");
    return static_cast<std::uint64_t>(numbers->front());
  }

  /// The counts of the step's partitions, and where the step begins in the arrays.
  Status readCounts() {
    std::uint64_t first = 0;
    for (const auto& [name, into] :
         {std::pair{"PartOffsets", &first}, std::pair{"PointOffsets", &point_},
          std::pair{"CellOffsets", &cell_}, std::pair{"ConnectivityIdOffsets", &corner_}}) {
      const auto number = atStep(name, std::nullopt);
      if (!number) return std::unexpected(number.error());
      *into = *number;
    }
    row_ = first;
    const auto points = file_.array(under("NumberOfPoints"));
    if (!points) return std::unexpected(points.error());
    if (first > points->rows)
      return file_.bad("its steps begin behind its partitions; export the mesh again");
    const auto count = partitionsFrom(first, points->rows);
    if (!count) return std::unexpected(count.error());
    if (*count > points->rows - first)
      return file_.bad("a step has " + std::to_string(*count) + " partitions from number " +
                       std::to_string(first) + " on, but there are " +
                       std::to_string(points->rows) + "; export the mesh again");
    counts_.resize(*count);
    for (const auto& [name, member] :
         {std::pair{"NumberOfPoints", &Counts::points}, std::pair{"NumberOfCells", &Counts::cells},
          std::pair{"NumberOfConnectivityIds", &Counts::corners}}) {
      const auto array = file_.array(under(name));
      if (!array) return std::unexpected(array.error());
      const auto numbers = file_.integers(*array, first, *count);
      if (!numbers) return std::unexpected(numbers.error());
      for (std::size_t i = 0; i < *count; ++i) {
        if ((*numbers)[i] < 0 || (*numbers)[i] > kMaxCount)
          return file_.bad("its array " + array->name + " says " + std::to_string((*numbers)[i]) +
                           " for partition " + std::to_string(first + i) +
                           "; export the mesh again");
        counts_[i].*member = static_cast<std::uint64_t>((*numbers)[i]);
      }
    }
    return {};
  }

  /// How many partitions the step has. Files of version 2.0 may not say so: then it has those up to
  /// the next step's.
  Result<std::uint64_t> partitionsFrom(std::uint64_t first, std::uint64_t all) {
    if (!step_) return all;
    if (file_.has(under("Steps/NumberOfParts"))) return atStep("NumberOfParts", std::nullopt);
    const auto offsets = file_.allIntegers(under("Steps/PartOffsets"));
    if (!offsets) return std::unexpected(offsets.error());
    std::uint64_t end = all;
    for (const std::int64_t offset : *offsets)
      if (std::cmp_greater(offset, first)) end = std::min(end, static_cast<std::uint64_t>(offset));
    return end - first;
  }

  Status chooseFields() {
    FieldChoice choice(wanted_, report_);
    CellMesh names;
    for (const Association* of : {&kOfPoints, &kOfCells}) {
      int number = 0;
      for (const std::string& name : file_.arraysIn(under(of->group))) {
        auto array = file_.array(under(std::string(of->group) + "/" + name));
        if (!array) return std::unexpected(array.error());
        const std::uint64_t begin = of == &kOfPoints ? point_ : cell_;
        const auto first = atStep(std::string(of->group) + "Offsets/" + name, begin);
        if (!first) return std::unexpected(first.error());
        const std::uint64_t shift = *first - begin;
        if (of == &kOfCells && name == kGhostTypes) ghosts_ = Field{*array, of, name, shift};
        if (of == &kOfPoints && std::ranges::find(kGlobalIdNames, name) != std::end(kGlobalIdNames))
          ids_ = Field{*array, of, name, shift};
        const auto chosen = choice.nameOf(
            {name, number++, array->columns, !array->type.empty(), false}, of->name, names);
        if (chosen) fields_.push_back({std::move(*array), of, *chosen, shift});
      }
    }
    otherFields_ = std::move(names.otherFields);
    return {};
  }

  Result<CellMesh> readPartition() {
    out_ = {};
    out_.otherFields = otherFields_;
    rows_.clear();
    for (const auto part : {&StepReader::readPoints, &StepReader::readCells, &StepReader::readIds,
                            &StepReader::readFields})
      if (Status done = (this->*part)(); !done) return std::unexpected(done.error());
    return std::move(out_);
  }

  [[nodiscard]] const Counts& counts() const { return counts_[partition_]; }

  Status readPoints() {
    const auto array = file_.array(under("Points"));
    if (!array) return std::unexpected(array.error());
    if (array->columns != 3)
      return file_.bad("its array " + array->name + " has " + std::to_string(array->columns) +
                       " columns, not 3; export the mesh again");
    const auto numbers = file_.reals(*array, point_, counts().points);
    if (!numbers) return std::unexpected(numbers.error());
    out_.pointType = array->type == "float32" ? "float32" : "float64";
    out_.points.resize(counts().points);
    for (std::size_t i = 0; i < numbers->size(); ++i) out_.points[i / 3][i % 3] = (*numbers)[i];
    return {};
  }

  Result<std::vector<std::int64_t>> column(const char* name, std::uint64_t first,
                                           std::uint64_t count) const {
    const auto array = file_.array(under(name));
    if (!array) return std::unexpected(array.error());
    if (array->columns != 1)
      return file_.bad("its array " + array->name + " has " + std::to_string(array->columns) +
                       " columns, not one; export the mesh again");
    return file_.integers(*array, first, count);
  }

  Status readCells() {
    if (counts().cells == 0) return {};
    const auto types = column("Types", cell_, counts().cells);
    if (!types) return std::unexpected(types.error());
    // a partition has one offset more than cells
    const auto ends = column("Offsets", cell_ + row_ + partition_, counts().cells + 1);
    if (!ends) return std::unexpected(ends.error());
    const auto corners = column("Connectivity", corner_, counts().corners);
    if (!corners) return std::unexpected(corners.error());
    std::vector<double> marks;
    if (ghosts_) {
      auto read = file_.reals(ghosts_->array, cell_ + ghosts_->shift, counts().cells);
      if (!read) return std::unexpected(read.error());
      marks = std::move(*read);
    }
    std::vector<VertexId> ids;
    for (std::size_t cell = 0; cell < types->size(); ++cell) {
      const std::int64_t type = (*types)[cell], begin = (*ends)[cell], end = (*ends)[cell + 1];
      if (type < 0 || type > 255)
        return file_.bad("cell " + std::to_string(cell) +
                         " has a type that is not 0 to 255; the file is damaged, export it again");
      if (begin < 0 || end < begin || std::cmp_greater(end, corners->size()))
        return file_.bad(verticesOutside(cell));
      if (dimensionOf(static_cast<std::uint8_t>(type)) != 3) {
        ++report_.ignoredCells;
        continue;
      }
      if (!marks.empty() &&
          (static_cast<unsigned>(std::clamp(marks[cell], 0.0, 255.0)) & kElsewhere) != 0)
        continue;
      if (type == kPolyhedronCell)
        return file_.bad("cell " + std::to_string(cell) +
                         " is a polyhedron, which is not read of .vtkhdf; save the mesh as .vtu");
      ids.clear();
      for (std::int64_t at = begin; at < end; ++at) {
        const std::int64_t id = (*corners)[static_cast<std::size_t>(at)];
        ids.push_back(std::cmp_less(id, counts().points) ? narrowedId(id) : kGhost);
      }
      out_.addCell(static_cast<std::uint8_t>(type), ids);
      rows_.push_back(cell);
    }
    if (rows_.size() < types->size()) out_.cellIds = rows_;
    return {};
  }

  Status readIds() {
    if (!ids_ || ids_->array.columns != 1 || ids_->array.type.starts_with("float")) return {};
    const auto ids = file_.integers(ids_->array, point_ + ids_->shift, counts().points);
    if (!ids) return std::unexpected(ids.error());
    out_.pointIds.assign(ids->begin(), ids->end());
    return {};
  }

  Status readFields() {
    for (const Field& field : fields_) {
      const bool isOfPoints = field.of == &kOfPoints;
      const std::uint64_t tuples = isOfPoints ? counts().points : counts().cells;
      auto values = file_.reals(field.array, (isOfPoints ? point_ : cell_) + field.shift, tuples);
      if (!values) return std::unexpected(values.error());
      MeshField into{field.name, static_cast<std::uint32_t>(field.array.columns), field.array.type,
                     std::move(*values), field.of->name};
      if (!isOfPoints) keepRows(into, rows_);
      out_.fields.push_back(std::move(into));
    }
    return {};
  }

  /// A partition's counts are at most this, so that no sum of two is beyond 2^64.
  static constexpr std::int64_t kMaxCount = std::int64_t{1} << 48;

  const HdfFile& file_;
  std::optional<std::size_t> step_;
  const FieldNames& wanted_;
  ReadReport& report_;

  std::vector<Counts> counts_;  ///< of the step's partitions
  std::vector<Field> fields_;
  std::optional<Field> ghosts_, ids_;
  std::vector<std::string> otherFields_;

  /// The first row of the present partition's points, cells and corners, and of the step's counts.
  std::uint64_t point_ = 0, cell_ = 0, corner_ = 0, row_ = 0;
  std::uint64_t partition_ = 0;
  CellMesh out_;
  std::vector<std::uint64_t> rows_;  ///< the kept cells
};

}  // namespace

Result<VtkHdfFile> VtkHdfFile::open(const std::filesystem::path& path) {
  Result<HdfFile> file = HdfFile::open(path);
  if (!file) return std::unexpected(file.error());
  const std::optional<std::string> type = file->textOf(kRoot, "Type");
  if (!type)
    return file->bad("it has no group VTKHDF with a Type; it is damaged, or no file of VTK");
  VtkHdfFile out(std::move(*file));
  out.type_ = *type;
  if (!out.file_.has(under("Steps"))) return out;
  if (!out.isGrid())
    return out.file_.bad("it holds time steps of " + *type +
                         ", which are not read; save each step as a file of its own");
  if (Status done = out.readTimes(); !done) return std::unexpected(done.error());
  return out;
}

Status VtkHdfFile::readTimes() {
  Result<std::vector<double>> times = file_.allReals(under("Steps/Values"));
  if (!times) return std::unexpected(times.error());
  times_ = std::move(*times);
  if (times_.empty()) return file_.bad("its group Steps has no times; export the mesh again");
  for (std::size_t i = 0; i < times_.size(); ++i)
    if (!std::isfinite(times_[i]) || (i > 0 && times_[i] <= times_[i - 1]))
      return file_.bad("the time of its step " + std::to_string(i) +
                       " is not later than the one before; export the mesh again");
  return {};
}

Result<std::vector<CellMesh>> VtkHdfFile::partitions(std::size_t step, const FieldNames& fields,
                                                     ReadReport& report) const {
  std::optional<std::size_t> row;
  if (!times_.empty()) row = step;
  return StepReader(file_, row, fields, report).read();
}

}  // namespace qtet
