// runVtk of a program that was built without VTK.
#include "simplify/read/vtk/run_vtk.h"

namespace qtet {

Result<std::vector<TimedCells>> runVtk(const std::filesystem::path& path, MeshFormat,
                                       const ReadOptions&, ReadReport&) {
  return fail(ErrorCode::kBadInput,
              path.string() +
                  ": its format is read by VTK, which this program was built without; "
                  "save the mesh as .vtu, or give it to the program of the Debian "
                  "package qtet");
}

}  // namespace qtet
