#include "simplify/vtk_grid.h"

#include <vtkLogger.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkOutputWindow.h>
#include <vtkUnstructuredGridReader.h>
#include <vtkXMLUnstructuredGridReader.h>

#include <exception>
#include <new>

#include "simplify/trial_process.h"
#include "simplify/vtk_file_checks.h"

namespace qtet {
namespace {

/// "ERROR: In FILE, line N\nvtkClass (0x1234): the message\n\n" becomes "the message" in one line.
std::string messageOf(const char* text) {
  std::string out = text ? text : "";
  if (const std::size_t address = out.find(" (0x"); address != std::string::npos) {
    if (const std::size_t colon = out.find("): ", address); colon != std::string::npos) out.erase(0, colon + 3);
  }
  for (char& c : out) {
    if (c == '\n' || c == '\r' || c == '\t') c = ' ';
  }
  out.erase(out.find_last_not_of(' ') + 1);
  return out;
}

/// Collects what VTK would print. Readers' helpers report to the global window only, so observers on the reader would miss them.
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
    // Messages go to the logger too, which would write them to stderr in its own form. Nothing else of ours logs through VTK.
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

std::unexpected<Error> bad(const std::filesystem::path& path, const std::string& what) {
  return fail(ErrorCode::kBadInput, path.string() + ": " + what);
}

vtkSmartPointer<vtkUnstructuredGrid> readXml(const std::filesystem::path& path) {
  vtkNew<vtkXMLUnstructuredGridReader> reader;
  reader->SetFileName(path.c_str());
  reader->Update();
  return reader->GetOutput();
}

vtkSmartPointer<vtkUnstructuredGrid> readLegacy(const std::filesystem::path& path) {
  vtkNew<vtkUnstructuredGridReader> reader;
  reader->SetFileName(path.c_str());
  reader->ReadAllScalarsOn();
  reader->ReadAllVectorsOn();
  reader->ReadAllNormalsOn();
  reader->ReadAllTensorsOn();
  reader->ReadAllTCoordsOn();
  reader->ReadAllFieldsOn();
  reader->Update();
  return reader->GetOutput();
}

}  // namespace

Result<vtkSmartPointer<vtkUnstructuredGrid>> readVtkGrid(const std::filesystem::path& path, std::vector<std::string>& notes) {
  const Result<VtkFormat> format = checkVtkFile(path);
  if (!format) return std::unexpected(format.error());
  const MessageCapture capture;
  // On counts that contradict each other VTK 9.1's legacy reader writes outside its arrays; its XML reader stood every damage that was tried.
  if (*format == VtkFormat::kLegacy && !survives([&] { readLegacy(path); })) {
    return bad(
        path,
        "VTK crashes on it: its counts contradict each other, or it is too large for this machine; export the mesh again, best as .vtu");
  }
  vtkSmartPointer<vtkUnstructuredGrid> grid;
  try {
    grid = *format == VtkFormat::kXml ? readXml(path) : readLegacy(path);
  } catch (const std::bad_alloc&) {
    return bad(path, "an array's stated length does not fit in memory; the file is damaged, or the machine too small for it");
  } catch (const std::exception& error) {
    return bad(path, std::string("VTK could not read it: ") + error.what());
  }
  if (!capture.messages().errors.empty()) {
    return bad(path, "VTK could not read it: " + capture.messages().errors.front() +
                         "; export the mesh again or open it in ParaView to see what it holds");
  }
  if (!grid) return bad(path, "VTK found no unstructured grid in it; export the mesh as .vtu again");
  for (const std::string& warning : capture.messages().warnings) notes.push_back("VTK: " + warning);
  return grid;
}

}  // namespace qtet
