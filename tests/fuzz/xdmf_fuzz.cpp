// Fuzzes the reader of XDMF with numbers in the XML (cell_mesh_fuzz.h). Files of HDF5 are for that
// library, and it would open what an input names.
#include <string_view>

#include "simplify/read/xdmf/read_xdmf.h"
#include "tests/fuzz/cell_mesh_fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace qtet;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  if (xdmfLower(text).contains("hdf")) return 0;
  const auto read = [](const std::string& path) -> Result<CellMesh> {
    Result<XdmfFile> file = XdmfFile::open(path);
    if (!file) return std::unexpected(file.error());
    if (!file->isUnderstood()) return fail(ErrorCode::kBadInput, "meshio reads it");
    ReadReport report;
    return file->read(file->times().empty() ? 0 : file->times().size() - 1, {}, report);
  };
  return testing::fuzzFile(data, size, read, testing::CellIds::kUnchecked);
}
