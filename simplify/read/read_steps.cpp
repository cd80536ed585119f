#include "simplify/read/read_steps.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <optional>
#include <utility>

#include "simplify/read/abaqus/read_abaqus.h"
#include "simplify/read/ensight/read_ensight.h"
#include "simplify/read/foam/read_foam.h"
#include "simplify/read/foreign/read_foreign.h"
#include "simplify/read/hdf/read_vtkhdf.h"
#include "simplify/read/nastran/read_nastran.h"
#include "simplify/read/options/time_steps.h"
#include "simplify/read/read_lists.h"
#include "simplify/read/steps/join_blocks.h"
#include "simplify/read/steps/read_apart.h"
#include "simplify/read/steps/step_reports.h"
#include "simplify/read/text/text_readers.h"
#include "simplify/read/vtu/read_xml_grid.h"
#include "simplify/read/xdmf/read_xdmf.h"

namespace qtet {
namespace {

using Path = std::filesystem::path;
using Steps = std::vector<TimedCells>;

Steps oneStep(TimedCells step) {
  Steps out;
  out.push_back(std::move(step));
  return out;
}

Result<Steps> readXml(const Path& path, MeshFormat format, const ReadOptions& options,
                      ReadReport& report, int) {
  Result<std::optional<TimedCells>> step = readXmlGrid(path, options, report);
  if (!step) return std::unexpected(step.error());
  return *step ? oneStep(std::move(**step)) : readByVtk(path, format, options, report);
}

/// Reads a legacy file without VTK, unless it holds what that alone reads.
Result<Steps> readLegacy(const std::filesystem::path& path, MeshFormat format,
                         const ReadOptions& options, ReadReport& report, int) {
  ReadReport found;
  Result<std::optional<CellMesh>> cells =
      readLegacyVtk(path, options.fields, found, options.patience);
  if (!cells) return std::unexpected(cells.error());
  if (!*cells) return readByVtk(path, format, options, report);
  return readChosen({}, path, options, report, [&](std::size_t, ReadReport& ofStep) {
    ofStep = std::move(found);
    return Result<CellMesh>(std::move(**cells));
  });
}

/// The step's partitions in one mesh.
Result<CellMesh> joinedPartitions(const VtkHdfFile& file, std::size_t step,
                                  const ReadOptions& options, ReadReport& report) {
  Result<std::vector<CellMesh>> blocks = file.partitions(step, options.fields, report);
  if (!blocks) return std::unexpected(blocks.error());
  return joinBlocks(std::move(*blocks), options, report);
}

Result<Steps> readHdfGrid(const std::filesystem::path& path, const ReadOptions& options,
                          ReadReport& report) {
  const Result<VtkHdfFile> file = VtkHdfFile::open(path);
  if (!file) return std::unexpected(file.error());
  if (!file->isGrid()) return readByVtk(path, MeshFormat::kVtkHdf, options, report);
  return readChosen(file->times(), path, options, report,
                    [&](std::size_t step, ReadReport& ofStep) {
                      return joinedPartitions(*file, step, options, ofStep);
                    });
}

Result<Steps> readVtkHdf(const Path& path, MeshFormat, const ReadOptions& options,
                         ReadReport& report, int) {
  return readApart(path, options, report,
                   [&](ReadReport& found) { return readHdfGrid(path, options, found); });
}

Result<Steps> readXdmf(const Path& path, MeshFormat, const ReadOptions& options, ReadReport& report,
                       int) {
  Result<XdmfFile> file = XdmfFile::open(path);
  if (!file) return std::unexpected(file.error());
  if (!file->isUnderstood())
    return readForeign({path, ForeignLibrary::kMeshio, "xdmf", {}, options.patience}, options,
                       report);
  return readApart(path, options, report, [&](ReadReport& found) {
    std::ranges::copy(file->notes(), std::back_inserter(found.notes));
    return readChosen(
        file->times(), path, options, found,
        [&](std::size_t step, ReadReport& ofStep) { return file->read(step, options, ofStep); });
  });
}

/// A reader of files without steps.
template <auto kRead>
Result<Steps> whole(const Path& path, MeshFormat, const ReadOptions& options, ReadReport& report,
                    int) {
  if (const auto steps = chosenSteps({}, options.time, path, report.notes); !steps)
    return std::unexpected(steps.error());
  Result<CellMesh> cells = kRead(path, report, options.patience);
  if (!cells) return std::unexpected(cells.error());
  return oneStep({"", std::move(*cells)});
}

Result<Steps> readGmshFile(const Path& path, MeshFormat, const ReadOptions& options,
                           ReadReport& report, int) {
  Result<CellMesh> cells = readGmsh(path, options.time, report, options.patience);
  if (!cells) return std::unexpected(cells.error());
  return oneStep({"", std::move(*cells)});
}

template <auto kRead>
Result<Steps> inSteps(const Path& path, MeshFormat, const ReadOptions& options, ReadReport& report,
                      int) {
  return kRead(path, options, report);
}

Result<Steps> throughVtk(const Path& path, MeshFormat format, const ReadOptions& options,
                         ReadReport& report, int) {
  return readByVtk(path, format, options, report);
}

Result<Steps> throughMeshio(const Path& path, MeshFormat format, const ReadOptions& options,
                            ReadReport& report, int) {
  const std::string kind = format == MeshFormat::kAnsys ? "ansys" : options.format;
  return readForeign({path, ForeignLibrary::kMeshio, kind, {}, options.patience}, options, report);
}

struct Reader {
  MeshFormat format;
  Result<Steps> (*read)(const Path& path, MeshFormat format, const ReadOptions& options,
                        ReadReport& report, int depth);
};
constexpr auto kReaders = std::to_array<Reader>({
    {MeshFormat::kVtu, readXml},
    {MeshFormat::kVts, readXml},
    {MeshFormat::kVtr, readXml},
    {MeshFormat::kVti, readXml},
    {MeshFormat::kPvtu, readParts},
    {MeshFormat::kPvts, readParts},
    {MeshFormat::kPvtr, readParts},
    {MeshFormat::kPvti, readParts},
    {MeshFormat::kVtm, readParts},
    {MeshFormat::kPvd, readSeries},
    {MeshFormat::kSeries, readSeries},
    {MeshFormat::kLegacyVtk, readLegacy},
    {MeshFormat::kVtkHdf, readVtkHdf},
    {MeshFormat::kExodus, throughVtk},
    {MeshFormat::kExodusPieces, readExodusPieces},
    {MeshFormat::kEnSight, inSteps<readEnSight>},
    {MeshFormat::kCgns, throughVtk},
    {MeshFormat::kAvsUcd, throughVtk},
    {MeshFormat::kOpenFoam, inSteps<readFoam>},
    {MeshFormat::kFluent, throughVtk},
    {MeshFormat::kXdmf, readXdmf},
    {MeshFormat::kPlot3d, throughVtk},
    {MeshFormat::kGmsh, readGmshFile},
    {MeshFormat::kMedit, whole<readMedit>},
    {MeshFormat::kTetgen, whole<readTetgen>},
    {MeshFormat::kSu2, whole<readSu2>},
    {MeshFormat::kUnv, whole<readUnv>},
    {MeshFormat::kAbaqus, whole<readAbaqus>},
    {MeshFormat::kNastran, whole<readNastran>},
    {MeshFormat::kAnsys, throughMeshio},
    {MeshFormat::kOther, throughMeshio},
});

}  // namespace

Result<Steps> readSteps(const Path& path, MeshFormat format, const ReadOptions& options,
                        ReadReport& report, int depth) {
  return std::ranges::find(kReaders, format, &Reader::format)
      ->read(path, format, options, report, depth);
}

}  // namespace qtet
