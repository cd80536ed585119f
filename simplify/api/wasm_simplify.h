// The simplifier as C functions for WebAssembly: a mesh file in, a log out. One call a module
// instance, in a worker that the page ends to cancel; memory that runs out ends the instance by a
// trap. Files are those of the WASI functions that the page provides.
#pragma once

#include <cstdint>

extern "C" {

/// Memory for bytes that the page hands in.
void* qtet_alloc(std::uint32_t bytes);

/// Does what `qtet simplify NAME` does without options: the same bytes. `name` (UTF-8,
/// NUL-terminated) is a file that the page provides as /NAME. The mesh is simplified in parts of
/// some `cellsOfAPart` cells, 0: in one piece. Returns 0, or 1 + ErrorCode; then qtet_report()
/// is the error's message with its byte.
int qtet_simplify_file(const char* name, std::uint32_t cellsOfAPart);

/// JSON, NUL-terminated: {"notes": [texts], "warnings": [texts], "tetrahedra": number}.
const char* qtet_report();
const std::uint8_t* qtet_log();
std::uint32_t qtet_log_bytes();

/// Provided by the page: the stage's number (Stage of pipeline.h, -1 reading) and its fraction.
[[clang::import_module("qtet"), clang::import_name("progress")]] void qtet_page_progress(
    std::int32_t stage, double fraction);

}  // extern "C"
