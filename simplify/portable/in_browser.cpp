// The readers that a browser does without beside those of without_libraries.cpp: of EnSight, of
// OpenFOAM's folders, and of files that name others. Exceptions end the module.
#include "simplify/portable/refused_format.h"
#include "simplify/read/ensight/read_ensight.h"
#include "simplify/read/foam/read_foam.h"
#include "simplify/read/listed_files.h"
#include "simplify/read/parts/piece_files.h"
#include "simplify/read/process/inflate_file.h"
#include "simplify/read/process/reading_time.h"
#include "simplify/read/steps/read_apart.h"
#include "simplify/read/xdmf/read_xdmf.h"

extern "C" {
void* __cxa_allocate_exception(std::size_t) { __builtin_trap(); }
[[noreturn]] void __cxa_throw(void*, void*, void (*)(void*)) { __builtin_trap(); }
}

namespace qtet {

Result<std::vector<TimedCells>> readApart(const std::filesystem::path& path, const ReadOptions&,
                                          ReadReport&, const StepReader&) {
  return refusedFormat(path);
}
Result<std::vector<TimedCells>> readEnSight(const std::filesystem::path& path, const ReadOptions&,
                                            ReadReport&) {
  return refusedFormat(path);
}
Result<std::vector<TimedCells>> readFoam(const std::filesystem::path& path, const ReadOptions&,
                                         ReadReport&) {
  return refusedFormat(path);
}

// The module has no clock. Whoever waits for a page can close it.
ReadingTime::ReadingTime(std::chrono::seconds patience, std::uint64_t) : patience_(patience) {}
void ReadingTime::addFile(std::uint64_t) {}
bool ReadingTime::isOver() const { return false; }
std::string ReadingTime::text() const {
  return "reading it takes longer than " + std::to_string(patience_.count()) + " s";
}
Status ReadingTime::check(const std::filesystem::path&) const { return {}; }

// The page inflates .gz before it hands the file over.
std::uint64_t maxInflatedBytes() { return 0; }
Status inflated(const std::filesystem::path& path,
                const std::function<Status(const std::filesystem::path&)>&, std::uint64_t) {
  return refusedFormat(path);
}
Status unmarked(const std::filesystem::path& path,
                const std::function<Status(const std::filesystem::path&)>&) {
  return refusedFormat(path);
}
std::string withName(std::string text, const std::string&, const std::string&) { return text; }

Result<std::vector<std::filesystem::path>> exodusPieces(const std::filesystem::path& path) {
  return refusedFormat(path);
}
bool isFoamCase(const std::filesystem::path&) { return false; }
bool namesFiles(const std::filesystem::path&) { return false; }
Result<ReadOptions> withListedFiles(const std::filesystem::path&, const ReadOptions& options) {
  return options;
}
Result<std::vector<std::filesystem::path>> processorFolders(const std::filesystem::path& marker) {
  return refusedFormat(marker);
}

Result<XdmfFile> XdmfFile::open(const std::filesystem::path& path) { return refusedFormat(path); }
Result<CellMesh> XdmfFile::read(std::size_t, const ReadOptions&, ReadReport&) {
  return refusedFormat(path_);
}

}  // namespace qtet
