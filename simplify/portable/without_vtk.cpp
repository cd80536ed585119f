// runVtk of a program that was built without VTK.
#include "simplify/read/process/run_meshio.h"
#include "simplify/read/read_steps.h"
#include "simplify/read/vtk/run_vtk.h"

namespace qtet {
namespace {

/// Meshio's word for the format; null: it does not read it.
const char* meshioKind(MeshFormat format) {
  switch (format) {
    case MeshFormat::kLegacyVtk: return "vtk";
    case MeshFormat::kAvsUcd: return "avsucd";
    case MeshFormat::kExodus: return "exodus";
    default: return nullptr;
  }
}

}  // namespace

Result<std::vector<TimedCells>> runVtk(const std::filesystem::path& path, MeshFormat format,
                                       const ReadOptions& options, ReadReport& report) {
  const char* kind = meshioKind(format);
  if (kind == nullptr)
    return fail(ErrorCode::kBadInput,
                path.string() +
                    ": its format is read by VTK, which this program was built without; "
                    "save the mesh as .vtu, give it to the program of the Debian package qtet, "
                    "or read it by PyVista and give the grid to qtet.simplify");
  Result<std::vector<TimedCells>> out = std::vector<TimedCells>();
  const Status done = throughMeshio({path, kind, options.time, options.patience},
                                    [&](const std::filesystem::path& file) -> Status {
                                      out = readSteps(file, formatOf(file), options, report);
                                      if (!out) return std::unexpected(out.error());
                                      return {};
                                    });
  if (!done) return std::unexpected(done.error());
  return out;
}

}  // namespace qtet
