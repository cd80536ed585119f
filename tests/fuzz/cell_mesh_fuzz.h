// A reader of mesh files that is given any bytes. It gives an error, or a mesh whose arrays agree.
#pragma once

#include <sys/mman.h>
#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <string>

#include "simplify/mesh/tet_mesh.h"
#include "simplify/split/cell_mesh.h"

namespace qtet::testing {

/// Whether all cells name points that are there. Where some may not, the next step checks the ids
/// (checkCellMesh).
enum class CellIds : std::uint8_t { kThere, kUnchecked };

/// `read(path)` gives a Result<CellMesh>.
template <class Read>
int fuzzFile(const std::uint8_t* data, std::size_t size, const Read& read,
             CellIds ids = CellIds::kThere) {
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
    if (ids == CellIds::kThere && id >= mesh->points.size()) std::abort();
  for (const MeshField& field : mesh->fields) {
    const std::size_t tuples = isCellField(field) ? mesh->cells() : mesh->points.size();
    if (field.values.size() != tuples * field.components) std::abort();
  }
  return 0;
}

}  // namespace qtet::testing
