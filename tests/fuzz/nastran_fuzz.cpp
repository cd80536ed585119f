// Fuzzes the reader of Nastran's bulk data: an error, or a mesh whose arrays agree in length and
// whose cells name points that are there.
#include <sys/mman.h>
#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <string>

#include "simplify/read/nastran/read_nastran.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace qtet;
  static const int file = ::memfd_create("model.bdf", MFD_CLOEXEC);
  if (file < 0 || ::ftruncate(file, 0) != 0 ||
      ::pwrite(file, data, size, 0) != static_cast<ssize_t>(size))
    std::abort();
  ReadReport report;
  const auto read = readNastran("/proc/self/fd/" + std::to_string(file), report);
  if (!read) {
    if (read.error().message.empty()) std::abort();
    return 0;
  }
  if (read->begins.size() != read->cells() + 1 || read->begins.back() != read->vertices.size())
    std::abort();
  for (const VertexId id : read->vertices)
    if (id >= read->points.size()) std::abort();
  for (const MeshField& field : read->fields)
    if (field.values.size() != read->cells()) std::abort();
  return 0;
}
