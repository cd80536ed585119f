// Unstructured grids of VTK's HDF5 (docs.vtk.org, "VTKHDF format specification", versions 1.0 to
// 2.x), with their partitions and time steps.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "simplify/read/hdf/hdf_file.h"
#include "simplify/read/options/read_options.h"
#include "simplify/split/cell_mesh.h"

namespace qtet {

class VtkHdfFile {
 public:
  /// Errors: bad-input (no group VTKHDF with a Type; steps that contradict each other; steps of
  /// another kind than unstructured grids, which are not read).
  [[nodiscard]] static Result<VtkHdfFile> open(const std::filesystem::path& path);

  /// Whether it holds an unstructured grid: the functions below read no other kind.
  [[nodiscard]] bool isGrid() const { return type_ == "UnstructuredGrid"; }
  /// The times of its steps, ascending; empty: it has none.
  [[nodiscard]] const std::vector<double>& times() const { return times_; }
  /// The partitions of a step (0 if there are none): visible volume cells that are no other
  /// partition's, points as they are, the fields meant by `fields`. Errors: bad-input (arrays that
  /// are missing or contradict the counts; polyhedra). Throws as HdfFile does. REQUIRES isGrid().
  [[nodiscard]] Result<std::vector<CellMesh>> partitions(std::size_t step, const FieldNames& fields,
                                                         ReadReport& report) const;

 private:
  explicit VtkHdfFile(HdfFile file) : file_(std::move(file)) {}
  Status readTimes();

  HdfFile file_;
  std::string type_;
  std::vector<double> times_;
};

}  // namespace qtet
