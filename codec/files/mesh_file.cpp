#include "codec/files/mesh_file.h"

#include <algorithm>
#include <cassert>

#include "codec/files/boundary_drc.h"
#include "codec/files/boundary_glb.h"
#include "codec/files/vtu_writer.h"

namespace qtet {

bool needsLattice(std::string_view ending) { return ending == ".glb" || ending == ".drc"; }

bool holdsFields(std::string_view ending, std::string_view association) {
  if (ending == ".obj") return false;
  return association != "cell" || !needsLattice(ending);
}

Result<Bytes> meshFileBytes(const FileMesh& mesh, std::string_view ending) {
  if (ending == ".vtu") return vtuBytes(mesh);
  if (ending == ".vtk") return legacyVtkBytes(mesh);
  if (ending == ".msh") return gmshBytes(mesh);
  if (ending == ".obj") return objBytes(surfaceOf(mesh));
  assert(ending == ".usda");
  return usdaBytes(mesh);
}

Result<Bytes> meshFileBytes(const LatticeMesh& mesh, std::string_view ending,
                            const MeshFileOptions& options) {
  if (ending == ".glb") return options.draco ? boundaryGlb(mesh) : plainBoundaryGlb(mesh);
  if (ending == ".drc") return boundaryDrc(mesh);
  return meshFileBytes(fileMesh(mesh).mesh, ending);
}

}  // namespace qtet
