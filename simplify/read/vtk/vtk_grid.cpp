#include "simplify/read/vtk/vtk_grid.h"

#include <sys/mman.h>
#include <unistd.h>
#include <vtkAlgorithm.h>
#include <vtkCompositeDataIterator.h>
#include <vtkCompositeDataSet.h>
#include <vtkDataSet.h>
#include <vtkInformation.h>
#include <vtkLogger.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkOutputWindow.h>
#include <vtkSmartPointer.h>
#include <vtkStreamingDemandDrivenPipeline.h>
#include <vtkXMLDataElement.h>
#include <vtkXMLUtilities.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <exception>
#include <new>

#include "simplify/read/foam/foam_fields.h"
#include "simplify/read/foam/poly_mesh.h"
#include "simplify/read/hdf/read_vtkhdf.h"
#include "simplify/read/options/mesh_format.h"
#include "simplify/read/options/time_steps.h"
#include "simplify/read/parts/file_series.h"
#include "simplify/read/parts/piece_files.h"
#include "simplify/read/process/guarded_folder.h"
#include "simplify/read/process/inflate_file.h"
#include "simplify/read/process/trial_process.h"
#include "simplify/read/vtk/cell_transfer.h"
#include "simplify/read/vtk/join_blocks.h"
#include "simplify/read/vtk/vtk_cells.h"
#include "simplify/read/vtk/vtk_readers.h"
#include "simplify/read/vtu/read_vtu.h"
#include "simplify/read/xdmf/read_xdmf.h"

namespace qtet {
namespace {

/// "ERROR: In FILE, line N\nvtkClass (0x1234): the message\n\n" becomes "the message" in one line.
std::string messageOf(const char* text) {
  std::string out = text ? text : "";
  if (const std::size_t address = out.find(" (0x"); address != std::string::npos) {
    if (const std::size_t colon = out.find("): ", address); colon != std::string::npos)
      out.erase(0, colon + 3);
  }
  for (char& c : out) {
    if (c == '\n' || c == '\r' || c == '\t') c = ' ';
  }
  out.erase(out.find_last_not_of(" .") + 1);  // a sentence of ours goes on behind it
  return out;
}

/// Collects what VTK would print. Readers' helpers report to the global window only, so observers
/// on the reader would miss them.
class MessageWindow : public vtkOutputWindow {
 public:
  static MessageWindow* New();
  vtkTypeMacro(MessageWindow, vtkOutputWindow) MessageWindow(const MessageWindow&) = delete;
  MessageWindow& operator=(const MessageWindow&) = delete;

  void DisplayText(const char*) override {}
  void DisplayDebugText(const char*) override {}
  void DisplayErrorText(const char* text) override { errors.push_back(messageOf(text)); }
  void DisplayWarningText(const char* text) override { warnings.push_back(messageOf(text)); }
  void DisplayGenericWarningText(const char* text) override { warnings.push_back(messageOf(text)); }

  std::vector<std::string> errors;
  std::vector<std::string> warnings;

 protected:
  MessageWindow() = default;
};
vtkStandardNewMacro(MessageWindow);

/// The window above in place of VTK's own while this lives.
class MessageCapture {
 public:
  MessageCapture() : previous_(vtkOutputWindow::GetInstance()) {
    vtkOutputWindow::SetInstance(window_);
    // Messages go to the logger too, which would write them to stderr in its own form. Nothing else
    // of ours logs through VTK.
    vtkLogger::SetStderrVerbosity(vtkLogger::VERBOSITY_OFF);
  }
  MessageCapture(const MessageCapture&) = delete;
  MessageCapture& operator=(const MessageCapture&) = delete;
  ~MessageCapture() { vtkOutputWindow::SetInstance(previous_); }

  [[nodiscard]] const MessageWindow& messages() const { return *window_; }

 private:
  vtkSmartPointer<vtkOutputWindow> previous_;
  vtkNew<MessageWindow> window_;
};

/// Files that name files that name files: a series of .vtm of .pvtu has three.
constexpr int kMaxDepth = 8;

bool isSeries(MeshFormat format) {
  return format == MeshFormat::kPvd || format == MeshFormat::kSeries;
}

std::unexpected<Error> bad(const std::filesystem::path& path, const std::string& what) {
  return fail(ErrorCode::kBadInput, path.string() + ": " + what);
}

/// The volume blocks of what a reader gave, in one mesh.
Result<CellMesh> cellsOfOutput(vtkDataObject* output, const ReadOptions& options,
                               const std::filesystem::path& path, ReadReport& report) {
  std::vector<CellMesh> blocks;
  const auto add = [&](vtkDataObject* object) -> Status {
    auto* data = vtkDataSet::SafeDownCast(object);
    if (!data || data->GetNumberOfCells() + data->GetNumberOfPoints() == 0) return {};
    Result<CellMesh> cells = cellsOf(*data, options.fields, path, report);
    if (!cells) return std::unexpected(cells.error());
    blocks.push_back(std::move(*cells));
    return {};
  };
  auto* composite = vtkCompositeDataSet::SafeDownCast(output);
  if (!composite) {
    if (!vtkDataSet::SafeDownCast(output))
      return bad(path, "VTK found no mesh in it; export the mesh as .vtu");
    if (Status done = add(output); !done) return std::unexpected(done.error());
    return blocks.empty() ? CellMesh{} : std::move(blocks.front());
  }
  const auto each = vtkSmartPointer<vtkCompositeDataIterator>::Take(composite->NewIterator());
  for (each->InitTraversal(); !each->IsDoneWithTraversal(); each->GoToNextItem()) {
    if (Status done = add(each->GetCurrentDataObject()); !done)
      return std::unexpected(done.error());
  }
  return joinBlocks(std::move(blocks), options.joinPieces, report);
}

std::vector<double> timesOf(vtkAlgorithm& reader) {
  vtkInformation* info = reader.GetOutputInformation(0);
  if (!info || !info->Has(vtkStreamingDemandDrivenPipeline::TIME_STEPS())) return {};
  const double* times = info->Get(vtkStreamingDemandDrivenPipeline::TIME_STEPS());
  return {times, times + info->Length(vtkStreamingDemandDrivenPipeline::TIME_STEPS())};
}

/// Adds the texts that are not there yet.
void addNew(std::vector<std::string>& from, std::vector<std::string>& to) {
  for (std::string& text : from)
    if (std::ranges::find(to, text) == to.end()) to.push_back(std::move(text));
}

/// Adds the report on one step more. Every step has the same mesh, so counts are those of one, and
/// earlier notes need not be repeated.
void addStep(ReadReport&& step, bool isFirst, ReadReport& report) {
  report.pieces = step.pieces;
  report.joinedPoints = step.joinedPoints;
  report.joinedByIds = step.joinedByIds;
  if (isFirst) {
    report.ignoredCells += step.ignoredCells;
    report.ignoredFields.insert(report.ignoredFields.end(), step.ignoredFields.begin(),
                                step.ignoredFields.end());
  }
  addNew(step.notes, report.notes);
}

/// Adds the report on one piece of a result.
void addPiece(ReadReport&& piece, ReadReport& report) {
  report.ignoredCells += piece.ignoredCells;
  addNew(piece.ignoredFields, report.ignoredFields);
  addNew(piece.notes, report.notes);
}

/// Reads the steps that are meant. `readStep(number, report)` gives the mesh of one of `times`, or
/// of the file without times.
template <class ReadStep>
Result<std::vector<TimedCells>> readSteps(const std::vector<double>& times,
                                          const std::filesystem::path& path,
                                          const ReadOptions& options, ReadReport& report,
                                          const ReadStep& readStep) {
  const auto steps = chosenSteps(times, options.time, path, report.notes);
  if (!steps) return std::unexpected(steps.error());
  std::vector<TimedCells> out;
  for (std::size_t s = 0; s < std::max<std::size_t>(1, steps->size()); ++s) {
    const bool timed = !steps->empty();
    const std::size_t number = timed ? (*steps)[s] : 0;
    ReadReport step;
    Result<CellMesh> cells = readStep(number, step);
    if (!cells) return std::unexpected(cells.error());
    addStep(std::move(step), s == 0, report);
    out.push_back({timed ? timeText(times[number]) : "", std::move(*cells)});
  }
  return out;
}

/// The step's partitions in one mesh.
Result<CellMesh> joinedPartitions(const VtkHdfFile& file, std::size_t step,
                                  const ReadOptions& options, ReadReport& report) {
  Result<std::vector<CellMesh>> blocks = file.partitions(step, options.fields, report);
  if (!blocks) return std::unexpected(blocks.error());
  return joinBlocks(std::move(*blocks), options.joinPieces, report);
}

/// Runs one reader over the steps that are meant.
Result<std::vector<TimedCells>> runReader(const std::filesystem::path& path, MeshFormat format,
                                          const ReadOptions& options, ReadReport& report) {
  if (format == MeshFormat::kVtkHdf) {
    const Result<VtkHdfFile> file = VtkHdfFile::open(path);
    if (!file) return std::unexpected(file.error());
    if (file->isGrid())
      return readSteps(file->times(), path, options, report,
                       [&](std::size_t step, ReadReport& ofStep) {
                         return joinedPartitions(*file, step, options, ofStep);
                       });
  }
  if (format == MeshFormat::kXdmf) {
    Result<XdmfFile> file = XdmfFile::open(path);
    if (!file) return std::unexpected(file.error());
    return readSteps(file->times(), path, options, report,
                     [&](std::size_t step, ReadReport& ofStep) {
                       return file->read(step, options.fields, ofStep);
                     });
  }
  const auto reader = vtkReaderOf(path, format, options);
  reader->UpdateInformation();
  const std::vector<double> times = timesOf(*reader);
  return readSteps(times, path, options, report,
                   [&](std::size_t step, ReadReport& ofStep) -> Result<CellMesh> {
                     if (times.empty())
                       reader->Update();
                     else
                       reader->UpdateTimeStep(times[step]);
                     Result<CellMesh> cells =
                         cellsOfOutput(reader->GetOutputDataObject(0), options, path, ofStep);
                     const std::string lacking = cells ? missingVariable(*reader) : "";
                     if (lacking.empty()) return cells;
                     return bad(path, "its variable " + lacking +
                                          " has no values: its file is cut off, or of another "
                                          "mesh; export the case again, or take the variable out "
                                          "of it");
                   });
}

/// Why the trial of a reader did not come to its end; what to do about it.
std::unexpected<Error> trialFailed(TrialEnd end, const std::filesystem::path& path,
                                   std::chrono::seconds patience) {
  switch (end) {
    case TrialEnd::kStuck:
      return bad(path, "VTK has read nothing of it for " + std::to_string(patience.count()) +
                           " s, so that it seems to wait for what the file does not hold; if it "
                           "is only large, give it longer with `readSeconds`, else export the "
                           "mesh again, best as .vtu");
    case TrialEnd::kOutOfMemory:
      return bad(path,
                 "VTK wants more memory for it than this machine has: a count in it is wrong, or "
                 "it is too large for this machine; export the mesh again, best as .vtu");
    default:
      return bad(path,
                 "VTK crashes on it: its counts contradict each other, or it is too large for this "
                 "machine; export the mesh again, best as .vtu");
  }
}

/// A Fluent mesh alone is no fault; VTK looks for a file of results beside it.
bool isOfMissingResults(MeshFormat format, const std::string& message) {
  return format == MeshFormat::kFluent && (message.starts_with("Could not open data file") ||
                                           message.starts_with("Unable to open dat file"));
}

/// VTK's readers with their messages and exceptions as values.
Result<std::vector<TimedCells>> readHere(const std::filesystem::path& path, MeshFormat format,
                                         const ReadOptions& options, ReadReport& report) {
  const MessageCapture capture;
  Result<std::vector<TimedCells>> steps = std::vector<TimedCells>{};
  try {
    steps = runReader(path, format, options, report);
  } catch (const std::bad_alloc&) {
    return bad(path,
               "an array's stated length does not fit in memory; the file is damaged, or the "
               "machine too small for it");
  } catch (const std::exception& error) {
    return bad(path, std::string("VTK could not read it: ") + error.what());
  }
  for (const std::string& error : capture.messages().errors) {
    if (!isOfMissingResults(format, error))
      return bad(path, "VTK could not read it: " + error +
                           "; export the mesh again or open it in ParaView to see what it holds");
  }
  for (const std::string& warning : capture.messages().warnings)
    if (!isOfMissingResults(format, warning)) report.notes.push_back("VTK: " + warning);
  return steps;
}

/// The same in a process of its own, for readers that damage can break. They may write beyond their
/// arrays without a crash, but they spoil no memory of ours.
Result<std::vector<TimedCells>> readApart(const std::filesystem::path& path, MeshFormat format,
                                          const ReadOptions& options, ReadReport& report) {
  const int file = ::memfd_create("qtet-read", MFD_CLOEXEC);
  if (file < 0)
    return fail(ErrorCode::kIo,
                "no room for what " + path.string() + " holds: " + std::strerror(errno));
  const TrialEnd end = tryOut(
      [&] {
        ReadReport found;
        const Result<std::vector<TimedCells>> steps = readHere(path, format, options, found);
        sendCells(file, steps, found);
      },
      options.patience);
  Result<std::vector<TimedCells>> out = end == TrialEnd::kDone
                                            ? receiveCells(file, report)
                                            : trialFailed(end, path, options.patience);
  ::close(file);
  return out;
}

/// Reads a .vtu file without VTK, unless it holds several steps, which no program writes any more.
Result<std::vector<TimedCells>> readUnstructured(const std::filesystem::path& path,
                                                 const ReadOptions& options, ReadReport& report) {
  const Result<VtuFile> file = VtuFile::open(path);
  if (!file) return std::unexpected(file.error());
  const Result<VtuDocument> document = readVtuDocument(*file);
  if (!document) return std::unexpected(document.error());
  if (document->hasTimeSteps) return readApart(path, MeshFormat::kVtu, options, report);
  const auto time = readVtuTime(*file, *document);
  if (!time) return std::unexpected(time.error());
  std::vector<double> times;
  if (*time) times.push_back(**time);
  if (const auto steps = chosenSteps(times, options.time, path, report.notes); !steps)
    return std::unexpected(steps.error());
  ReadReport step;
  Result<CellMesh> cells = readVtu(*file, *document, options.fields, step);
  if (!cells) return std::unexpected(cells.error());
  addStep(std::move(step), true, report);
  std::vector<TimedCells> out;
  out.push_back({*time ? timeText(**time) : "", std::move(*cells)});
  return out;
}

/// The files that a .pvd file names.
Result<std::vector<SeriesEntry>> entriesOf(const std::filesystem::path& path) {
  const MessageCapture capture;
  const auto root =
      vtkSmartPointer<vtkXMLDataElement>::Take(vtkXMLUtilities::ReadElementFromFile(path.c_str()));
  vtkXMLDataElement* collection = root ? root->FindNestedElementWithName("Collection") : nullptr;
  if (!collection) return bad(path, "it holds no <Collection>; save the series again");
  std::vector<SeriesEntry> entries;
  for (int i = 0; i < collection->GetNumberOfNestedElements(); ++i) {
    vtkXMLDataElement* element = collection->GetNestedElement(i);
    const char* file = element->GetAttribute("file");
    if (!file)
      return bad(path, "its <DataSet> number " + std::to_string(i) +
                           " names no file; save the series again");
    SeriesEntry entry{0, i, path.parent_path() / file};
    element->GetScalarAttribute("timestep", entry.time);
    entries.push_back(std::move(entry));
  }
  if (entries.empty()) return bad(path, "its <Collection> is empty; save the series again");
  sortByTime(entries);
  return entries;
}

/// readVtk of a file that is named by one that is named by one ..., `depth` of them.
Result<std::vector<TimedCells>> readAt(const std::filesystem::path& path, MeshFormat format,
                                       const ReadOptions& options, ReadReport& report, int depth);

/// The cells of the files that the file at `path` names as parts of one mesh. Each is read alone
/// and by a reader of its own. VTK's readers of such files believe what the summary says of types
/// and components, and write beyond their arrays where a part has others.
Result<CellMesh> cellsOfParts(std::span<const std::filesystem::path> parts,
                              const std::filesystem::path& path, const ReadOptions& options,
                              ReadReport& report, int depth) {
  std::vector<CellMesh> blocks;
  ReadOptions ofPart = options;
  ofPart.time = "last";  // the step is chosen already, and a part knows no times
  for (const std::filesystem::path& part : parts) {
    const MeshFormat format = formatOf(part);
    if (isSeries(format) || format >= MeshFormat::kGmsh)
      return bad(path, "it names " + part.string() +
                           ", but may name VTK's files alone; convert that to .vtu first");
    if (Status checked = checkMeshFile(part, format); !checked)
      return fail(checked.error().code, path.string() + " names it: " + checked.error().message);
    ReadReport ofOne;
    Result<std::vector<TimedCells>> read = readAt(part, format, ofPart, ofOne, depth + 1);
    if (!read) return std::unexpected(read.error());
    addPiece(std::move(ofOne), report);
    blocks.push_back(std::move(read->back().cells));
  }
  const bool isOne = blocks.size() == 1;
  CellMesh out = joinBlocks(std::move(blocks), options.joinPieces, report);
  if (isOne) report.pieces = 1;
  return out;
}

/// The Source of each Piece that a summary names.
Result<std::vector<std::filesystem::path>> piecesOf(const std::filesystem::path& path,
                                                    MeshFormat format) {
  const MessageCapture capture;
  const auto root =
      vtkSmartPointer<vtkXMLDataElement>::Take(vtkXMLUtilities::ReadElementFromFile(path.c_str()));
  const std::string type(rootType(format));
  vtkXMLDataElement* grid = root ? root->FindNestedElementWithName(type.c_str()) : nullptr;
  if (!grid) return bad(path, "it holds no <" + type + ">; save it again");
  std::vector<std::filesystem::path> out;
  for (int i = 0; i < grid->GetNumberOfNestedElements(); ++i) {
    vtkXMLDataElement* element = grid->GetNestedElement(i);
    if (std::string_view(element->GetName()) != "Piece") continue;
    const char* file = element->GetAttribute("Source");
    if (!file)
      return bad(path, "its <Piece> number " + std::to_string(out.size()) +
                           " names no file; save it again");
    out.push_back(path.parent_path() / file);
  }
  if (out.empty()) return bad(path, "it names no <Piece>; save it again");
  return out;
}

/// The files of a .vtm file's blocks, depth first. Those that can hold no volume cells (surfaces,
/// tables) are noted.
void addBlockFiles(vtkXMLDataElement& element, const std::filesystem::path& path,
                   std::vector<std::filesystem::path>& out, ReadReport& report) {
  constexpr std::array kVolumes{".vtu", ".vts",  ".vtr",  ".vti",  ".vtk",
                                ".vtm", ".pvtu", ".pvts", ".pvtr", ".pvti"};
  for (int i = 0; i < element.GetNumberOfNestedElements(); ++i) {
    vtkXMLDataElement& child = *element.GetNestedElement(i);
    if (const char* file = child.GetAttribute("file")) {
      const std::filesystem::path part = path.parent_path() / file;
      if (std::ranges::find(kVolumes, part.extension()) != kVolumes.end())
        out.push_back(part);
      else
        report.notes.push_back("its block " + part.filename().string() +
                               " was ignored: such a file holds no volume cells");
    }
    addBlockFiles(child, path, out, report);
  }
}

Result<std::vector<std::filesystem::path>> blocksOf(const std::filesystem::path& path,
                                                    ReadReport& report) {
  const MessageCapture capture;
  const auto root =
      vtkSmartPointer<vtkXMLDataElement>::Take(vtkXMLUtilities::ReadElementFromFile(path.c_str()));
  vtkXMLDataElement* set = root ? root->FindNestedElementWithName("vtkMultiBlockDataSet") : nullptr;
  if (!set) return bad(path, "it holds no <vtkMultiBlockDataSet>; save it again");
  std::vector<std::filesystem::path> out;
  addBlockFiles(*set, path, out, report);
  return out;
}

/// A file that names the parts of one mesh.
Result<std::vector<TimedCells>> readParts(const std::filesystem::path& path, MeshFormat format,
                                          const ReadOptions& options, ReadReport& report,
                                          int depth) {
  if (depth == kMaxDepth)
    return bad(path, "files that name files go deeper than " + std::to_string(kMaxDepth) +
                         "; does one name itself?");
  if (const auto steps = chosenSteps({}, options.time, path, report.notes); !steps)
    return std::unexpected(steps.error());
  const auto parts = namesPieces(format) ? piecesOf(path, format) : blocksOf(path, report);
  if (!parts) return std::unexpected(parts.error());
  Result<CellMesh> cells = cellsOfParts(*parts, path, options, report, depth);
  if (!cells) return std::unexpected(cells.error());
  std::vector<TimedCells> out;
  out.push_back({"", std::move(*cells)});
  return out;
}

Result<std::vector<TimedCells>> readSeries(const std::filesystem::path& path, MeshFormat format,
                                           const ReadOptions& options, ReadReport& report) {
  const auto entries = format == MeshFormat::kPvd ? entriesOf(path) : entriesOfJson(path);
  if (!entries) return std::unexpected(entries.error());
  std::vector<double> times;
  std::vector<std::size_t> begins;
  for (std::size_t i = 0; i < entries->size(); ++i) {
    if (!times.empty() && times.back() == (*entries)[i].time) continue;
    times.push_back((*entries)[i].time);
    begins.push_back(i);
  }
  begins.push_back(entries->size());
  const auto steps = chosenSteps(times, options.time, path, report.notes);
  if (!steps) return std::unexpected(steps.error());
  std::vector<TimedCells> out;
  for (const std::size_t s : *steps) {
    ReadReport step;
    std::vector<std::filesystem::path> parts;
    for (std::size_t i = begins[s]; i < begins[s + 1]; ++i) parts.push_back((*entries)[i].file);
    Result<CellMesh> cells = cellsOfParts(parts, path, options, step, 0);
    if (!cells) return std::unexpected(cells.error());
    addStep(std::move(step), s == steps->front(), report);
    out.push_back({timeText(times[s]), std::move(*cells)});
  }
  return out;
}

/// "0, 0.5", at most some of them.
std::string timesIn(std::span<const TimedCells> steps) {
  constexpr std::size_t kShown = 6;
  std::string out;
  for (const TimedCells& step : steps.first(std::min(kShown, steps.size())))
    out += (out.empty() ? "" : ", ") + (step.time.empty() ? "none" : step.time);
  return out + (steps.size() > kShown ? " and so on" : "");
}

/// The steps of one result's pieces, step by step in one mesh.
Result<std::vector<TimedCells>> joinedPieces(std::vector<std::vector<TimedCells>> pieces,
                                             const std::filesystem::path& path,
                                             const ReadOptions& options, ReadReport& report) {
  const auto timesDiffer = [&](const std::vector<TimedCells>& piece) {
    return !std::ranges::equal(piece, pieces.front(), {}, &TimedCells::time, &TimedCells::time);
  };
  if (const auto other = std::ranges::find_if(pieces, timesDiffer); other != pieces.end())
    return bad(path, "its pieces have different time steps, " + timesIn(pieces.front()) +
                         " in piece 0 and " + timesIn(*other) + " in piece " +
                         std::to_string(other - pieces.begin()) +
                         "; name one that all have with `time`, or write the missing ones");
  std::vector<TimedCells> out;
  for (std::size_t s = 0; s < pieces.front().size(); ++s) {
    std::vector<CellMesh> blocks;
    for (std::vector<TimedCells>& piece : pieces) blocks.push_back(std::move(piece[s].cells));
    ReadReport step;
    CellMesh cells = joinBlocks(std::move(blocks), options.joinPieces, step);
    addStep(std::move(step), s == 0, report);
    out.push_back({pieces.front()[s].time, std::move(cells)});
  }
  return out;
}

Result<std::vector<TimedCells>> readExodusPieces(const std::filesystem::path& path,
                                                 const ReadOptions& options, ReadReport& report) {
  const auto files = exodusPieces(path);
  if (!files) return std::unexpected(files.error());
  std::vector<std::vector<TimedCells>> pieces;
  for (const std::filesystem::path& file : *files) {
    ReadReport ofOne;
    Result<std::vector<TimedCells>> steps = readApart(file, MeshFormat::kExodus, options, ofOne);
    if (!steps) return steps;
    addPiece(std::move(ofOne), report);
    pieces.push_back(std::move(*steps));
  }
  return joinedPieces(std::move(pieces), path, options, report);
}

/// A case of OpenFOAM in one folder. `marker` is the file that VTK opens for it.
Result<std::vector<TimedCells>> readFoamCase(const std::filesystem::path& folder,
                                             const std::filesystem::path& marker,
                                             const ReadOptions& options, ReadReport& report) {
  const auto cells = checkPolyMeshes(folder);
  if (!cells) return std::unexpected(cells.error());
  Result<std::vector<TimedCells>> steps = readApart(marker, MeshFormat::kOpenFoam, options, report);
  if (!steps) return steps;
  for (const TimedCells& step : *steps)
    if (*cells && step.cells.cells() != **cells)
      return bad(folder, "VTK found " + std::to_string(step.cells.cells()) + " of its " +
                             std::to_string(**cells) +
                             " cells; run checkMesh on the case, and write it again");
  return steps;
}

/// A decomposed case of OpenFOAM: each processor's folder is read as a case of its own.
Result<std::vector<TimedCells>> readProcessors(const std::vector<std::filesystem::path>& processors,
                                               const std::filesystem::path& path,
                                               const ReadOptions& options, ReadReport& report) {
  const GuardedFolder folder("foam");
  if (folder.failure())
    return fail(ErrorCode::kIo, "no temporary folder could be made (" + folder.failure().message() +
                                    "); let TMPDIR name one with room");
  std::vector<std::vector<TimedCells>> pieces;
  for (const std::filesystem::path& processor : processors) {
    const auto marker = caseOfProcessor(processor, folder.path() / processor.filename());
    if (!marker) return std::unexpected(marker.error());
    ReadReport ofOne;
    Result<std::vector<TimedCells>> steps = readFoamCase(processor, *marker, options, ofOne);
    const auto named = [&](const std::string& text) {
      return withName(withName(text, marker->string(), processor.string()),
                      marker->parent_path().string(), processor.string());
    };
    for (std::string& note : ofOne.notes) note = named(note);
    addPiece(std::move(ofOne), report);
    if (!steps) return fail(steps.error().code, named(steps.error().message));
    pieces.push_back(std::move(*steps));
  }
  report.notes.push_back("the case was read from the folders of its " +
                         std::to_string(processors.size()) + " processors");
  return joinedPieces(std::move(pieces), path, options, report);
}

Result<std::vector<TimedCells>> readFoam(const std::filesystem::path& path,
                                         const ReadOptions& options, ReadReport& report) {
  const auto processors = processorFolders(path);
  if (!processors) return std::unexpected(processors.error());
  ReadOptions ofCells = options;
  ofCells.fields = foamFieldsToRead(options.fields);
  const std::filesystem::path folder = path.parent_path().empty() ? "." : path.parent_path();
  Result<std::vector<TimedCells>> steps = processors->empty()
                                              ? readFoamCase(folder, path, ofCells, report)
                                              : readProcessors(*processors, path, ofCells, report);
  if (!steps) return steps;
  std::vector<std::string> notes;
  for (TimedCells& step : *steps) foamFieldsAtPoints(options.fields, step.cells, notes);
  addNew(notes, report.notes);
  return steps;
}

Result<std::vector<TimedCells>> readAt(const std::filesystem::path& path, MeshFormat format,
                                       const ReadOptions& options, ReadReport& report, int depth) {
  if (isSeries(format)) return readSeries(path, format, options, report);
  if (format == MeshFormat::kVtu) return readUnstructured(path, options, report);
  if (format == MeshFormat::kExodusPieces) return readExodusPieces(path, options, report);
  if (format == MeshFormat::kOpenFoam) return readFoam(path, options, report);
  if (namesPieces(format) || format == MeshFormat::kVtm)
    return readParts(path, format, options, report, depth);
  return readApart(path, format, options, report);
}

}  // namespace

Result<std::vector<TimedCells>> readVtk(const std::filesystem::path& path, MeshFormat format,
                                        const ReadOptions& options, ReadReport& report) {
  return readAt(path, format, options, report, 0);
}

}  // namespace qtet
