// A reader of mesh files that is given any bytes. It gives an error, or a mesh whose arrays agree
// in length and whose cells name points that are there.
#pragma once

#include <sys/mman.h>
#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <string>

#include "simplify/mesh/tet_mesh.h"
#include "simplify/split/cell_mesh.h"

namespace qtet::testing {

/// `read(path)` gives a Result<CellMesh>, whose fields are all of cells and of one component.
template <class Read>
int fuzzFile(const std::uint8_t* data, std::size_t size, const Read& read) {
  static const int file = ::memfd_create("mesh", MFD_CLOEXEC);
  if (file < 0 || ::ftruncate(file, 0) != 0 ||
      ::pwrite(file, data, size, 0) != static_cast<ssize_t>(size))
    std::abort();
  const auto mesh = read("/proc/self/fd/" + std::to_string(file));
  if (!mesh) {
    if (mesh.error().message.empty()) std::abort();
    return 0;
  }
  if (mesh->begins.size() != mesh->cells() + 1 || mesh->begins.back() != mesh->vertices.size())
    std::abort();
  for (const VertexId id : mesh->vertices)
    if (id >= mesh->points.size()) std::abort();
  for (const MeshField& field : mesh->fields)
    if (field.values.size() != mesh->cells()) std::abort();
  return 0;
}

}  // namespace qtet::testing
