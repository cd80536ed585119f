// The objects behind the handles of the C API (codec/api/qtet.h, simplify/api/qtet_simplify.h), and
// the border that no exception crosses. For the library's own .cpp files.
#pragma once

#include <cstdint>
#include <map>
#include <new>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "codec/api/qtet.h"
#include "codec/refine/log_file.h"
#include "codec/refine/refiner.h"
#include "proto/manifest.h"
#include "proto/series.h"

namespace qtet {

[[nodiscard]] qtet_status statusOf(ErrorCode code);

/// The last failure of a handle.
struct Failure {
  std::string message;
  const char* text = "";  // `message`, or a literal where memory is short

  qtet_status refuse(qtet_status code, std::string why) {
    message = std::string(qtet_status_name(code)) + ": " + std::move(why);
    text = message.c_str();
    return code;
  }
  qtet_status refuse(const Error& error);
};

}  // namespace qtet

struct qtet_log : qtet::Failure {
  static constexpr const char* kShortOfMemory =
      "out-of-memory: there is not enough memory; refine to a coarser level";

  std::optional<qtet::LogFile> file;
  qtet::Manifest manifest;                                 // of `file`
  std::vector<std::string> units;                          // of its fields, and then of times
  std::map<std::string, std::string, std::less<>> labels;  // by name without @TIME, as JSON
  std::optional<qtet::Refiner> refiner;                    // of `file`, with a complete level

  // Checks of a call's arguments. Each returns QTET_OK or refuses.
  qtet_status needField(std::uint32_t field);
  qtet_status needLevel(std::uint32_t level);
  qtet_status needSeries(std::uint32_t number);
  qtet_status needPlace(const void* place) {
    return place != nullptr ? QTET_OK
                            : refuse(QTET_BAD_ARGUMENT, "the place for the answer is null");
  }
};

namespace qtet {

/// Runs `work`, which gives a qtet_status; what it throws becomes one. Null is refused.
template <class Handle, class Work>
qtet_status guarded(Handle* handle, const Work& work) noexcept {
  if (handle == nullptr) return QTET_BAD_ARGUMENT;
  try {
    return work();
  } catch (const std::bad_alloc&) {
    handle->text = Handle::kShortOfMemory;
    return QTET_OUT_OF_MEMORY;
  } catch (...) {
    handle->text =
        "internal: the library failed in a way that it should not; please report it with the log "
        "or the mesh";
    return QTET_INTERNAL;
  }
}

/// The same for what needs a log that is open.
template <class Work>
qtet_status withLog(qtet_log* log, const Work& work) noexcept {
  return guarded(log, [&] {
    return log->file
               ? work()
               : log->refuse(QTET_NO_LOG,
                             "nothing is open: qtet_log_open_file or qtet_log_open_memory first");
  });
}

/// The same for what needs a mesh.
template <class Work>
qtet_status withMesh(qtet_log* log, const Work& work) noexcept {
  return withLog(log, [&] {
    return log->refiner ? work()
                        : log->refuse(QTET_NO_MESH, "there is no mesh yet: qtet_log_refine first");
  });
}

}  // namespace qtet
