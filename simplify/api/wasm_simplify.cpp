#include "simplify/api/wasm_simplify.h"

#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "simplify/parts/metis_partition.h"
#include "simplify/pipeline/pipeline.h"
#include "simplify/read/read_mesh.h"

namespace {

std::string report;
qtet::Bytes logBytes;

int failed(const qtet::Error& error) {
  report = error.message;
  if (error.offset != qtet::Error::kNoOffset)
    report += " (byte " + std::to_string(error.offset) + ")";
  return 1 + static_cast<int>(error.code);
}

}  // namespace

extern "C" {

void* qtet_alloc(std::uint32_t bytes) { return std::malloc(bytes); }

int qtet_simplify_file(const char* name, std::uint32_t cellsOfAPart) {
  const std::filesystem::path path = std::filesystem::path("/") / name;
  qtet_page_progress(-1, 0);
  auto read = qtet::readMesh(path, qtet::ReadOptions{});
  if (!read) return failed(read.error());
  qtet::PipelineOptions options;
  options.source = name;
  if (cellsOfAPart > 0) options.parts = qtet::smallParts(qtet::metisPartitioner(), cellsOfAPart);
  options.progress = [](qtet::Stage stage, double fraction) {
    qtet_page_progress(static_cast<std::int32_t>(stage), fraction);
  };
  auto made = qtet::simplifyToLog(std::move(read->mesh), options);
  if (!made) return failed(made.error());
  auto log = made->log.bytes();
  if (!log) return failed(log.error());
  logBytes = std::move(*log);
  nlohmann::ordered_json out = {{"notes", read->report.notes},
                                {"warnings", read->report.warnings},
                                {"tetrahedra", made->report.tetrahedraIn}};
  for (const std::string& note : made->report.notes) out["notes"].push_back(note);
  for (const std::string& warning : made->report.warnings) out["warnings"].push_back(warning);
  report = out.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
  return 0;
}

const char* qtet_report() { return report.c_str(); }
const std::uint8_t* qtet_log() { return logBytes.data(); }
std::uint32_t qtet_log_bytes() { return static_cast<std::uint32_t>(logBytes.size()); }

}  // extern "C"
