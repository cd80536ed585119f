// The readers that a browser does without: those of HDF5, VTK, meshio, EnSight, and OpenFOAM's
// folders.
#include "simplify/read/ensight/read_ensight.h"
#include "simplify/read/foam/read_foam.h"
#include "simplify/read/foreign/read_foreign.h"
#include "simplify/read/hdf/read_vtkhdf.h"
#include "simplify/read/listed_files.h"
#include "simplify/read/parts/piece_files.h"
#include "simplify/read/process/inflate_file.h"
#include "simplify/read/process/reading_time.h"
#include "simplify/read/steps/read_apart.h"
#include "simplify/read/xdmf/read_xdmf.h"

namespace qtet {
namespace {

std::unexpected<Error> refusal(const std::filesystem::path& path) {
  return fail(ErrorCode::kBadInput,
              path.filename().string() +
                  ": the page does not read this format; make a log by `qtet simplify` and drop "
                  "that, or save the mesh as .vtu");
}

}  // namespace

Result<std::vector<TimedCells>> readApart(const std::filesystem::path& path, const ReadOptions&,
                                          ReadReport&, const StepReader&) {
  return refusal(path);
}
Result<std::vector<TimedCells>> readEnSight(const std::filesystem::path& path, const ReadOptions&,
                                            ReadReport&) {
  return refusal(path);
}
Result<std::vector<TimedCells>> readFoam(const std::filesystem::path& path, const ReadOptions&,
                                         ReadReport&) {
  return refusal(path);
}
Result<std::vector<TimedCells>> readForeign(const ForeignInput& input, const ReadOptions&,
                                            ReadReport&) {
  return refusal(input.path);
}
Result<std::vector<TimedCells>> readByVtk(const std::filesystem::path& path, MeshFormat,
                                          const ReadOptions&, ReadReport&) {
  return refusal(path);
}

// The module has no clock. Whoever waits for a page can close it.
ReadingTime::ReadingTime(std::chrono::seconds patience, std::uint64_t) : patience_(patience) {}
void ReadingTime::addFile(std::uint64_t) {}
bool ReadingTime::isOver() const { return false; }
std::string ReadingTime::text() const {
  return "reading it takes longer than " + std::to_string(patience_.count()) + " s";
}
Status ReadingTime::check(const std::filesystem::path&) const { return {}; }

// The page inflates .gz before it hands the file over.
std::uint64_t maxInflatedBytes() { return 0; }
Status inflated(const std::filesystem::path& path,
                const std::function<Status(const std::filesystem::path&)>&, std::uint64_t) {
  return refusal(path);
}
Status unmarked(const std::filesystem::path& path,
                const std::function<Status(const std::filesystem::path&)>&) {
  return refusal(path);
}
std::string withName(std::string text, const std::string&, const std::string&) { return text; }

Result<std::vector<std::filesystem::path>> exodusPieces(const std::filesystem::path& path) {
  return refusal(path);
}
bool isFoamCase(const std::filesystem::path&) { return false; }
bool namesFiles(const std::filesystem::path&) { return false; }
Result<ReadOptions> withListedFiles(const std::filesystem::path&, const ReadOptions& options) {
  return options;
}
Result<std::vector<std::filesystem::path>> processorFolders(const std::filesystem::path& marker) {
  return refusal(marker);
}

// No file is ever opened, so nothing below the functions named open is called.
Result<HdfFile> HdfFile::open(const std::filesystem::path& path) { return refusal(path); }
HdfFile::HdfFile(HdfFile&& other) noexcept : path_(std::move(other.path_)), id_(other.id_) {}
HdfFile::~HdfFile() = default;
Result<VtkHdfFile> VtkHdfFile::open(const std::filesystem::path& path) { return refusal(path); }
Result<std::vector<CellMesh>> VtkHdfFile::partitions(std::size_t, const FieldNames&,
                                                     ReadReport&) const {
  return refusal({});
}
Result<XdmfFile> XdmfFile::open(const std::filesystem::path& path) { return refusal(path); }
Result<CellMesh> XdmfFile::read(std::size_t, const ReadOptions&, ReadReport&) {
  return refusal(path_);
}

}  // namespace qtet
