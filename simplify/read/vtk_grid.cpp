#include "simplify/read/vtk_grid.h"

#include <fcntl.h>
#include <unistd.h>
#include <vtkAVSucdReader.h>
#include <vtkAlgorithm.h>
#include <vtkCGNSReader.h>
#include <vtkCompositeDataIterator.h>
#include <vtkCompositeDataSet.h>
#include <vtkDataSet.h>
#include <vtkDataSetReader.h>
#include <vtkExodusIIReader.h>
#include <vtkGenericEnSightReader.h>
#include <vtkInformation.h>
#include <vtkLogger.h>
#include <vtkMultiBlockPLOT3DReader.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkOpenFOAMReader.h>
#include <vtkOutputWindow.h>
#include <vtkSmartPointer.h>
#include <vtkStreamingDemandDrivenPipeline.h>
#include <vtkXMLDataElement.h>
#include <vtkXMLImageDataReader.h>
#include <vtkXMLMultiBlockDataReader.h>
#include <vtkXMLPUnstructuredGridReader.h>
#include <vtkXMLRectilinearGridReader.h>
#include <vtkXMLStructuredGridReader.h>
#include <vtkXMLUnstructuredGridReader.h>
#include <vtkXMLUtilities.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <functional>
#include <new>
#include <optional>

#include "simplify/read/fast_xml_parser.h"
#include "simplify/read/join_blocks.h"
#include "simplify/read/mesh_format.h"
#include "simplify/read/time_steps.h"
#include "simplify/read/trial_process.h"
#include "simplify/read/vtk_cells.h"

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

/// Libraries below VTK (Exodus, HDF5) print their errors themselves; what they mean comes as VTK's
/// message too.
class QuietStandardError {
 public:
  QuietStandardError() : kept_(::dup(STDERR_FILENO)) {
    const int nowhere = ::open("/dev/null", O_WRONLY);
    if (kept_ >= 0 && nowhere >= 0) ::dup2(nowhere, STDERR_FILENO);
    if (nowhere >= 0) ::close(nowhere);
  }
  QuietStandardError(const QuietStandardError&) = delete;
  QuietStandardError& operator=(const QuietStandardError&) = delete;
  ~QuietStandardError() {
    if (kept_ < 0) return;
    ::dup2(kept_, STDERR_FILENO);
    ::close(kept_);
  }

 private:
  int kept_;
};

std::unexpected<Error> bad(const std::filesystem::path& path, const std::string& what) {
  return fail(ErrorCode::kBadInput, path.string() + ": " + what);
}

template <class Reader>
vtkSmartPointer<vtkAlgorithm> xmlReader(const std::filesystem::path& path) {
  const auto reader = vtkSmartPointer<FastXmlReader<Reader>>::New();
  reader->SetFileName(path.c_str());
  return reader;
}

/// Of a file that names others, whose pieces are .vtu files.
class PiecesReader : public vtkXMLPUnstructuredGridReader {
 public:
  static PiecesReader* New();
  vtkTypeMacro(PiecesReader, vtkXMLPUnstructuredGridReader)
      PiecesReader(const PiecesReader&) = delete;
  PiecesReader& operator=(const PiecesReader&) = delete;

 protected:
  PiecesReader() = default;
  vtkXMLDataReader* CreatePieceReader() override {
    return FastXmlReader<vtkXMLUnstructuredGridReader>::New();
  }
};
vtkStandardNewMacro(PiecesReader);

vtkSmartPointer<vtkAlgorithm> legacyReader(const std::filesystem::path& path) {
  const auto reader = vtkSmartPointer<vtkDataSetReader>::New();
  reader->SetFileName(path.c_str());
  reader->ReadAllScalarsOn();
  reader->ReadAllVectorsOn();
  reader->ReadAllNormalsOn();
  reader->ReadAllTensorsOn();
  reader->ReadAllTCoordsOn();
  reader->ReadAllFieldsOn();
  return reader;
}

vtkSmartPointer<vtkAlgorithm> exodusReader(const std::filesystem::path& path) {
  const auto reader = vtkSmartPointer<vtkExodusIIReader>::New();
  reader->SetFileName(path.c_str());
  reader->SetSqueezePoints(false);  // every block has all points, so that blocks hang together
  reader->ApplyDisplacementsOff();  // the mesh is one over all steps
  reader->GenerateGlobalElementIdArrayOff();
  reader->GenerateGlobalNodeIdArrayOff();
  reader->UpdateInformation();
  reader->SetAllArrayStatus(vtkExodusIIReader::NODAL, 1);
  reader->SetAllArrayStatus(vtkExodusIIReader::ELEM_BLOCK, 1);
  return reader;
}

vtkSmartPointer<vtkAlgorithm> cgnsReader(const std::filesystem::path& path) {
  const auto reader = vtkSmartPointer<vtkCGNSReader>::New();
  reader->SetFileName(path.c_str());
  reader->UpdateInformation();
  reader->EnableAllBases();
  reader->EnableAllPointArrays();
  reader->EnableAllCellArrays();
  return reader;
}

vtkSmartPointer<vtkAlgorithm> enSightReader(const std::filesystem::path& path) {
  const auto reader = vtkSmartPointer<vtkGenericEnSightReader>::New();
  reader->SetCaseFileName(path.c_str());
  reader->ReadAllVariablesOn();
  return reader;
}

vtkSmartPointer<vtkAlgorithm> foamReader(const std::filesystem::path& path) {
  const auto reader = vtkSmartPointer<vtkOpenFOAMReader>::New();
  reader->SetFileName(path.c_str());
  reader->DecomposePolyhedraOff();
  reader->UpdateInformation();
  reader->EnableAllCellArrays();
  reader->EnableAllPointArrays();
  return reader;
}

vtkSmartPointer<vtkAlgorithm> plot3dReader(const std::filesystem::path& path,
                                           const std::string& solution) {
  // of vtkMultiBlockPLOT3DReader's functions, beside density, momentum and energy
  constexpr int kPressure = 110, kVelocity = 200;
  const auto reader = vtkSmartPointer<vtkMultiBlockPLOT3DReader>::New();
  reader->SetXYZFileName(path.c_str());
  reader->AutoDetectFormatOn();
  if (!solution.empty()) {
    reader->SetQFileName(solution.c_str());
    reader->AddFunction(kPressure);
    reader->AddFunction(kVelocity);
  }
  return reader;
}

vtkSmartPointer<vtkAlgorithm> readerOf(const std::filesystem::path& path, MeshFormat format,
                                       const ReadOptions& options) {
  switch (format) {
    case MeshFormat::kVtu: return xmlReader<vtkXMLUnstructuredGridReader>(path);
    case MeshFormat::kPvtu: return xmlReader<PiecesReader>(path);
    case MeshFormat::kVtm: return xmlReader<vtkXMLMultiBlockDataReader>(path);
    case MeshFormat::kVts: return xmlReader<vtkXMLStructuredGridReader>(path);
    case MeshFormat::kVtr: return xmlReader<vtkXMLRectilinearGridReader>(path);
    case MeshFormat::kVti: return xmlReader<vtkXMLImageDataReader>(path);
    case MeshFormat::kLegacyVtk: return legacyReader(path);
    case MeshFormat::kExodus: return exodusReader(path);
    case MeshFormat::kCgns: return cgnsReader(path);
    case MeshFormat::kEnSight: return enSightReader(path);
    case MeshFormat::kOpenFoam: return foamReader(path);
    case MeshFormat::kPlot3d: return plot3dReader(path, options.plot3dSolution);
    default: {
      const auto reader = vtkSmartPointer<vtkAVSucdReader>::New();
      reader->SetFileName(path.c_str());
      return reader;
    }
  }
}

/// VTK's XML readers stood every damage that was tried; its others write outside their arrays on
/// counts that contradict each other.
bool standsDamage(MeshFormat format) {
  return format == MeshFormat::kVtu || format == MeshFormat::kPvtu || format == MeshFormat::kVtm ||
         format == MeshFormat::kVts || format == MeshFormat::kVtr || format == MeshFormat::kVti;
}

/// The volume blocks of what a reader gave, in one mesh.
Result<CellMesh> cellsOfOutput(vtkDataObject* output, const FieldNames& fields,
                               const std::filesystem::path& path, ReadReport& report) {
  std::vector<CellMesh> blocks;
  const auto add = [&](vtkDataObject* object) -> Status {
    auto* data = vtkDataSet::SafeDownCast(object);
    if (!data || data->GetNumberOfCells() + data->GetNumberOfPoints() == 0) return {};
    Result<CellMesh> cells = cellsOf(*data, fields, path, report);
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
  return joinBlocks(std::move(blocks), report.notes);
}

std::vector<double> timesOf(vtkAlgorithm& reader) {
  vtkInformation* info = reader.GetOutputInformation(0);
  if (!info || !info->Has(vtkStreamingDemandDrivenPipeline::TIME_STEPS())) return {};
  const double* times = info->Get(vtkStreamingDemandDrivenPipeline::TIME_STEPS());
  return {times, times + info->Length(vtkStreamingDemandDrivenPipeline::TIME_STEPS())};
}

/// What reading one step more has told: every step has the same mesh, so that counts are those of
/// one, and what was said before need not be said again.
void addStep(ReadReport&& step, bool isFirst, ReadReport& report) {
  if (isFirst) {
    report.ignoredCells += step.ignoredCells;
    report.ignoredFields.insert(report.ignoredFields.end(), step.ignoredFields.begin(),
                                step.ignoredFields.end());
  }
  for (std::string& note : step.notes) {
    if (isFirst || std::ranges::find(report.notes, note) == report.notes.end())
      report.notes.push_back(std::move(note));
  }
}

/// Runs one reader over the steps that are meant.
Result<std::vector<TimedCells>> runReader(const std::filesystem::path& path, MeshFormat format,
                                          const ReadOptions& options, ReadReport& report) {
  const auto reader = readerOf(path, format, options);
  reader->UpdateInformation();
  const std::vector<double> times = timesOf(*reader);
  const auto steps = chosenSteps(times, options.time, path, report.notes);
  if (!steps) return std::unexpected(steps.error());
  std::vector<TimedCells> out;
  for (std::size_t s = 0; s < std::max<std::size_t>(1, steps->size()); ++s) {
    const bool timed = !steps->empty();
    if (timed)
      reader->UpdateTimeStep(times[(*steps)[s]]);
    else
      reader->Update();
    ReadReport step;
    Result<CellMesh> cells =
        cellsOfOutput(reader->GetOutputDataObject(0), options.fields, path, step);
    if (!cells) return std::unexpected(cells.error());
    addStep(std::move(step), s == 0, report);
    out.push_back({timed ? timeText(times[(*steps)[s]]) : "", std::move(*cells)});
  }
  return out;
}

/// VTK's readers with their messages caught; `work` is done in a process of its own first unless
/// the format stands damage.
Result<std::vector<TimedCells>> guarded(
    const std::filesystem::path& path, bool trial, ReadReport& report,
    const std::function<Result<std::vector<TimedCells>>()>& work) {
  const MessageCapture capture;
  if (trial && !survives([&] { (void)work(); })) {
    return bad(path,
               "VTK crashes on it: its counts contradict each other, or it is too large for this "
               "machine; export the mesh again, best as .vtu");
  }
  std::optional<QuietStandardError> quiet;
  if (trial) quiet.emplace();
  Result<std::vector<TimedCells>> steps = std::vector<TimedCells>{};
  try {
    steps = work();
  } catch (const std::bad_alloc&) {
    return bad(path,
               "an array's stated length does not fit in memory; the file is damaged, or the "
               "machine too small for it");
  } catch (const std::exception& error) {
    return bad(path, std::string("VTK could not read it: ") + error.what());
  }
  if (!capture.messages().errors.empty()) {
    return bad(path, "VTK could not read it: " + capture.messages().errors.front() +
                         "; export the mesh again or open it in ParaView to see what it holds");
  }
  for (const std::string& warning : capture.messages().warnings)
    report.notes.push_back("VTK: " + warning);
  return steps;
}

/// One <DataSet> of a .pvd file.
struct SeriesEntry {
  double time = 0;
  int number = 0;  ///< in the file
  std::filesystem::path file;
};

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
  std::ranges::sort(entries, [](const SeriesEntry& a, const SeriesEntry& b) {
    return a.time != b.time ? a.time < b.time : a.number < b.number;
  });
  return entries;
}

/// The pieces that a .pvtu file names, of which VTK says only a number. What else is wrong with the
/// file VTK tells.
Status checkPieces(const std::filesystem::path& path) {
  const MessageCapture capture;
  const auto root =
      vtkSmartPointer<vtkXMLDataElement>::Take(vtkXMLUtilities::ReadElementFromFile(path.c_str()));
  vtkXMLDataElement* grid = root ? root->FindNestedElementWithName("PUnstructuredGrid") : nullptr;
  for (int i = 0; grid && i < grid->GetNumberOfNestedElements(); ++i) {
    const char* file = grid->GetNestedElement(i)->GetAttribute("Source");
    if (!file) continue;
    if (Status checked = checkMeshFile(path.parent_path() / file, MeshFormat::kVtu); !checked)
      return fail(checked.error().code, path.string() + " names it: " + checked.error().message);
  }
  return {};
}

/// The parts of one step, each a file of its own, in one mesh.
Result<CellMesh> cellsOfParts(std::span<const SeriesEntry> parts, const std::filesystem::path& path,
                              const ReadOptions& options, ReadReport& report) {
  std::vector<CellMesh> blocks;
  ReadOptions ofPart = options;
  ofPart.time = "last";  // the step is chosen already, and a part knows no times
  for (const SeriesEntry& part : parts) {
    const MeshFormat format = formatOf(part.file);
    if (format == MeshFormat::kPvd || format >= MeshFormat::kGmsh)
      return bad(part.file, "a .pvd file may name VTK's files alone; convert it to .vtu first");
    if (Status checked = checkMeshFile(part.file, format); !checked)
      return fail(checked.error().code, path.string() + " names it: " + checked.error().message);
    Result<std::vector<TimedCells>> read = readVtk(part.file, format, ofPart, report);
    if (!read) return std::unexpected(read.error());
    blocks.push_back(std::move(read->back().cells));
  }
  return joinBlocks(std::move(blocks), report.notes);
}

Result<std::vector<TimedCells>> readSeries(const std::filesystem::path& path,
                                           const ReadOptions& options, ReadReport& report) {
  const auto entries = entriesOf(path);
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
    Result<CellMesh> cells = cellsOfParts(
        std::span(*entries).subspan(begins[s], begins[s + 1] - begins[s]), path, options, step);
    if (!cells) return std::unexpected(cells.error());
    addStep(std::move(step), s == steps->front(), report);
    out.push_back({timeText(times[s]), std::move(*cells)});
  }
  return out;
}

}  // namespace

Result<std::vector<TimedCells>> readVtk(const std::filesystem::path& path, MeshFormat format,
                                        const ReadOptions& options, ReadReport& report) {
  if (format == MeshFormat::kPvd) return readSeries(path, options, report);
  if (format == MeshFormat::kPvtu) {
    if (Status checked = checkPieces(path); !checked) return std::unexpected(checked.error());
  }
  return guarded(path, !standsDamage(format), report,
                 [&] { return runReader(path, format, options, report); });
}

}  // namespace qtet
