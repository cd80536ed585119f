// Fuzzes the reader of Nastran's bulk data (cell_mesh_fuzz.h).
#include "simplify/read/nastran/read_nastran.h"
#include "tests/fuzz/cell_mesh_fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  qtet::ReadReport report;
  return qtet::testing::fuzzFile(
      data, size, [&](const std::string& path) { return qtet::readNastran(path, report); });
}
