#include "simplify/read/vtk/run_vtk.h"

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

#include <exception>
#include <new>
#include <string_view>

#include "simplify/read/options/bad_file.h"
#include "simplify/read/steps/cell_labels.h"
#include "simplify/read/steps/join_blocks.h"
#include "simplify/read/steps/step_reports.h"
#include "simplify/read/vtk/vtk_cells.h"
#include "simplify/read/vtk/vtk_readers.h"

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

/// The name of the iterator's block; empty: the file gives it none.
std::string currentName(vtkCompositeDataIterator& each) {
  if (each.HasCurrentMetaData() == 0) return {};
  const char* name = each.GetCurrentMetaData()->Get(vtkCompositeDataSet::NAME());
  // VTK calls Exodus' blocks so that have no name
  return !name || std::string_view(name).starts_with("Unnamed block ID:") ? "" : name;
}

/// The volume blocks of what a reader gave, in one mesh.
Result<CellMesh> cellsOfOutput(vtkDataObject* output, const ReadOptions& options,
                               const std::filesystem::path& path, ReadReport& report) {
  std::vector<CellMesh> blocks;
  const auto add = [&](vtkDataObject* object, const std::string& name) -> Status {
    auto* data = vtkDataSet::SafeDownCast(object);
    if (!data || data->GetNumberOfCells() + data->GetNumberOfPoints() == 0) return {};
    Result<CellMesh> cells = cellsOf(*data, options.fields, path, report);
    if (!cells) return std::unexpected(cells.error());
    blocks.push_back(std::move(*cells));
    nameBlock(name, static_cast<std::int32_t>(blocks.size()), blocks.back());
    return {};
  };
  auto* composite = vtkCompositeDataSet::SafeDownCast(output);
  if (!composite) {
    if (!vtkDataSet::SafeDownCast(output))
      return badFile(path, "VTK found no mesh in it; export the mesh as .vtu");
    if (Status done = add(output, ""); !done) return std::unexpected(done.error());
    return blocks.empty() ? CellMesh{} : std::move(blocks.front());
  }
  const auto each = vtkSmartPointer<vtkCompositeDataIterator>::Take(composite->NewIterator());
  for (each->InitTraversal(); !each->IsDoneWithTraversal(); each->GoToNextItem()) {
    if (Status done = add(each->GetCurrentDataObject(), currentName(*each)); !done)
      return std::unexpected(done.error());
  }
  return joinBlocks(std::move(blocks), options, report);
}

std::vector<double> timesOf(vtkAlgorithm& reader) {
  vtkInformation* info = reader.GetOutputInformation(0);
  if (!info || !info->Has(vtkStreamingDemandDrivenPipeline::TIME_STEPS())) return {};
  const double* times = info->Get(vtkStreamingDemandDrivenPipeline::TIME_STEPS());
  return {times, times + info->Length(vtkStreamingDemandDrivenPipeline::TIME_STEPS())};
}

/// Runs the reader over the steps that are meant.
Result<std::vector<TimedCells>> runReader(const std::filesystem::path& path, MeshFormat format,
                                          const ReadOptions& options, ReadReport& report) {
  const auto reader = vtkReaderOf(path, format, options);
  reader->UpdateInformation();
  const std::vector<double> times = timesOf(*reader);
  return readChosen(times, path, options, report,
                    [&](std::size_t step, ReadReport& ofStep) -> Result<CellMesh> {
                      if (times.empty())
                        reader->Update();
                      else
                        reader->UpdateTimeStep(times[step]);
                      return cellsOfOutput(reader->GetOutputDataObject(0), options, path, ofStep);
                    });
}

/// A Fluent mesh alone is no fault; VTK looks for a file of results beside it.
bool isOfMissingResults(MeshFormat format, const std::string& message) {
  return format == MeshFormat::kFluent && (message.starts_with("Could not open data file") ||
                                           message.starts_with("Unable to open dat file"));
}

}  // namespace

Result<std::vector<TimedCells>> runVtk(const std::filesystem::path& path, MeshFormat format,
                                       const ReadOptions& options, ReadReport& report) {
  const MessageCapture capture;
  Result<std::vector<TimedCells>> steps = std::vector<TimedCells>{};
  try {
    steps = runReader(path, format, options, report);
  } catch (const std::bad_alloc&) {
    return badFile(path,
                   "an array's stated length does not fit in memory; the file is damaged, or the "
                   "machine too small for it");
  } catch (const std::exception& error) {
    return badFile(path, std::string("VTK could not read it: ") + error.what());
  }
  for (const std::string& error : capture.messages().errors) {
    if (!isOfMissingResults(format, error))
      return badFile(path,
                     "VTK could not read it: " + error +
                         "; export the mesh again or open it in ParaView to see what it holds");
  }
  for (const std::string& warning : capture.messages().warnings)
    if (!isOfMissingResults(format, warning)) report.notes.push_back("VTK: " + warning);
  return steps;
}

}  // namespace qtet
