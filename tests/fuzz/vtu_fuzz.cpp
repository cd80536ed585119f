// Fuzzes the reader of .vtu files: an error or a mesh, and the mesh's arrays agree in length.
#include <sys/mman.h>
#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "simplify/read/vtu/read_vtu.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace qtet;
  static const int memory = ::memfd_create("vtu-fuzz", MFD_CLOEXEC);
  static const std::filesystem::path path = "/proc/self/fd/" + std::to_string(memory);
  if (::ftruncate(memory, 0) != 0 || ::pwrite(memory, data, size, 0) != static_cast<ssize_t>(size))
    return 0;
  const Result<VtuFile> file = VtuFile::open(path);
  if (!file) std::abort();
  const Result<VtuDocument> document = readVtuDocument(*file);
  if (!document || document->hasTimeSteps) return 0;
  (void)readVtuTime(*file, *document);
  ReadReport report;
  const Result<CellMesh> mesh = readVtu(*file, *document, std::nullopt, report);
  if (!mesh) return 0;
  if (mesh->begins.size() != mesh->types.size() + 1 || mesh->begins.back() != mesh->vertices.size())
    std::abort();
  for (const MeshField& field : mesh->fields) {
    const std::size_t tuples = isCellField(field) ? mesh->types.size() : mesh->points.size();
    if (field.values.size() != tuples * field.components) std::abort();
  }
  return 0;
}
