#include "codec/files/mesh_file.h"

#include <algorithm>
#include <cassert>

#include "codec/files/boundary_drc.h"
#include "codec/files/boundary_glb.h"
#include "codec/files/vtu_writer.h"

namespace qtet {

bool needsLattice(std::string_view ending) { return ending == ".glb" || ending == ".drc"; }

bool holdsFields(std::string_view ending, std::string_view association) {
  assert(std::string_view(kWrittenEndings).find(ending) != std::string_view::npos);
  if (ending == ".obj") return false;
  return association != "cell" || !needsLattice(ending);
}

Status writeMeshFile(const FileMesh& mesh, std::string_view ending, const ByteSink& sink) {
  if (ending == ".vtu") return writeVtu(mesh, sink);
  if (ending == ".vtk") return writeLegacyVtk(mesh, sink);
  if (ending == ".msh") return writeGmsh(mesh, sink);
  if (ending == ".obj") return sink(objBytes(surfaceOf(mesh)));
  assert(ending == ".usda");
  return writeUsda(mesh, sink);
}

Result<Bytes> meshFileBytes(const FileMesh& mesh, std::string_view ending) {
  Bytes out;
  if (Status written = writeMeshFile(mesh, ending, appendTo(out)); !written)
    return std::unexpected(written.error());
  return out;
}

Result<Bytes> meshFileBytes(const LatticeMesh& mesh, std::string_view ending,
                            const MeshFileOptions& options) {
  if (ending == ".glb") return options.draco ? boundaryGlb(mesh) : plainBoundaryGlb(mesh);
  if (ending == ".drc") return boundaryDrc(mesh);
  return meshFileBytes(fileMesh(mesh).mesh, ending);
}

}  // namespace qtet
