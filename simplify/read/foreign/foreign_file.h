// Mesh files that libraries of Python read for us, VTK and meshio
// (https://vtk.org, https://github.com/nschloe/meshio), if they are installed.
#pragma once

#include <chrono>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "proto/error.h"
#include "simplify/read/parts/named_files.h"

namespace qtet {

enum class ForeignLibrary : std::uint8_t { kVtk, kMeshio };

/// What a library is to read.
struct ForeignInput {
  std::filesystem::path path;
  ForeignLibrary library = ForeignLibrary::kMeshio;
  /// A word of the library's program (vtk.py), or an ending that meshio knows; empty: as the name
  /// says.
  std::string kind;
  std::string companion{};            ///< a file beside it, such as PLOT3D's solution; empty: none
  std::chrono::seconds patience{60};  ///< as ReadOptions::patience
};

/// A mesh file that a Python program of ours has open (steps.py), in a process of its own with all
/// of the machine's memory at most. It writes each step that is asked for to a temporary folder, in
/// VTK's XML, which our own readers take for a stranger's. So damage that breaks the library harms
/// nothing else.
class ForeignFile {
 public:
  /// Errors: not-found (no Python, or no such library: the message says what to install),
  /// bad-input (the library's own last words; a kind of file that it does not know; no byte moved
  /// for `patience`; the process was ended), io.
  [[nodiscard]] static Result<ForeignFile> open(const ForeignInput& input);
  ForeignFile(ForeignFile&&) noexcept;
  ~ForeignFile();

  /// Ascending; empty: it has none, and one step.
  [[nodiscard]] const std::vector<double>& times() const { return times_; }
  /// The parts of the step's mesh; they go with the next step, or with this. `notes` gets what the
  /// library says. Errors: as open's. REQUIRES: a number of times(), or 0.
  [[nodiscard]] Result<std::vector<BlockFile>> step(std::size_t number,
                                                    std::vector<std::string>& notes);

 private:
  class Program;
  explicit ForeignFile(std::unique_ptr<Program> program);

  std::unique_ptr<Program> program_;
  std::vector<double> times_;
  std::vector<std::string> notes_;  ///< of opening
};

}  // namespace qtet
