// Fuzzes the reader of .vtu files and their kin (cell_mesh_fuzz.h).
#include "simplify/read/vtu/read_vtu.h"
#include "tests/fuzz/cell_mesh_fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace qtet;
  const auto read = [](const std::string& path) -> Result<CellMesh> {
    const Result<VtuFile> file = VtuFile::open(path);
    if (!file) std::abort();
    Result<VtuDocument> document = readVtuDocument(*file);
    if (!document) return std::unexpected(document.error());
    if (document->hasTimeSteps) return fail(ErrorCode::kBadInput, "VTK reads its steps");
    (void)readVtuTime(*file, *document);
    if (document->kind != GridKind::kUnstructured) document->pieces.resize(1);
    ReadReport report;
    return readVtu(*file, *document, std::nullopt, report);
  };
  return testing::fuzzFile(data, size, read, testing::CellIds::kUnchecked);
}
