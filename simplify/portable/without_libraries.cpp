// The readers that WebAssembly does without: those of HDF5, VTK and meshio.
#include "simplify/portable/refused_format.h"
#include "simplify/read/foreign/read_foreign.h"
#include "simplify/read/hdf/read_vtkhdf.h"

namespace qtet {

Result<std::vector<TimedCells>> readForeign(const ForeignInput& input, const ReadOptions&,
                                            ReadReport&) {
  return refusedFormat(input.path);
}
Result<std::vector<TimedCells>> readByVtk(const std::filesystem::path& path, MeshFormat,
                                          const ReadOptions&, ReadReport&) {
  return refusedFormat(path);
}

// No file is ever opened, so nothing below the functions named open is called.
Result<HdfFile> HdfFile::open(const std::filesystem::path& path) { return refusedFormat(path); }
HdfFile::HdfFile(HdfFile&& other) noexcept : path_(std::move(other.path_)), id_(other.id_) {}
HdfFile::~HdfFile() = default;
Result<HdfArray> HdfFile::array(const std::string&) const { return refusedFormat(path_); }
Result<std::vector<double>> HdfFile::reals(const HdfArray&, std::uint64_t, std::uint64_t) const {
  return refusedFormat(path_);
}
Result<std::vector<std::int64_t>> HdfFile::integers(const HdfArray&, std::uint64_t,
                                                    std::uint64_t) const {
  return refusedFormat(path_);
}
Result<VtkHdfFile> VtkHdfFile::open(const std::filesystem::path& path) {
  return refusedFormat(path);
}
Result<std::vector<CellMesh>> VtkHdfFile::partitions(std::size_t, const FieldNames&,
                                                     ReadReport&) const {
  return refusedFormat({});
}

}  // namespace qtet
