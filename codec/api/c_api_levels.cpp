// codec/api/qtet.h: the library itself, known errors, and choosing a level.
#include <array>
#include <string_view>

#include "codec/api/c_api_handle.h"
#include "codec/log/target_choice.h"
#include "codec/refine/refiner.h"

using qtet::Result;
using qtet::withLog;

namespace {

constexpr const char* kVersionText = QTET_VERSION;  // of the project, from CMakeLists.txt

/// "1.2.3" as QTET_VERSION_NUMBER has it.
constexpr std::uint32_t versionNumber(std::string_view text) {
  std::array<std::uint32_t, 3> parts{};
  std::size_t part = 0;
  for (const char c : text) {
    if (c == '.')
      ++part;
    else
      parts.at(part) = parts.at(part) * 10 + static_cast<std::uint32_t>(c - '0');
  }
  return parts[0] * 10000 + parts[1] * 100 + parts[2];
}
static_assert(versionNumber(kVersionText) == QTET_VERSION_NUMBER,
              "codec/api/qtet.h and the project have different versions");

qtet_status answer(qtet_log* log, const qtet::Target& target, std::uint32_t* out) {
  if (const qtet_status status = log->needPlace(out)) return status;
  const Result<std::uint32_t> level = qtet::levelFor(target, log->manifest, log->file->index());
  if (!level) return log->refuse(level.error());
  *out = *level;
  return QTET_OK;
}

qtet_status needBound(qtet_log* log, double bound) {
  return bound >= 0 ? QTET_OK
                    : log->refuse(QTET_BAD_ARGUMENT, "the bound is " + std::to_string(bound) +
                                                         "; it is a fraction of 0 or above");
}

}  // namespace

uint32_t qtet_version() { return versionNumber(kVersionText); }
const char* qtet_version_text() { return kVersionText; }

const char* qtet_status_name(qtet_status status) {
  switch (status) {
    case QTET_OK: return "ok";
    case QTET_TRUNCATED: return "truncated";
    case QTET_BAD_MAGIC: return "bad-magic";
    case QTET_BAD_VERSION: return "bad-version";
    case QTET_BAD_CHECKSUM: return "bad-checksum";
    case QTET_BAD_VALUE: return "bad-value";
    case QTET_LIMIT_EXCEEDED: return "limit-exceeded";
    case QTET_BAD_CODEC: return "bad-codec";
    case QTET_BAD_ORDER: return "bad-order";
    case QTET_NOT_FOUND: return "not-found";
    case QTET_BAD_INPUT: return "bad-input";
    case QTET_IO: return "io";
    case QTET_CANCELLED: return "cancelled";
    case QTET_BAD_ARGUMENT: return "bad-argument";
    case QTET_NO_LOG: return "no-log";
    case QTET_NO_MESH: return "no-mesh";
    case QTET_OUT_OF_MEMORY: return "out-of-memory";
    case QTET_INTERNAL: return "internal";
    default: return "unknown";
  }
}

qtet_status qtet_log_field_error(qtet_log* log, uint32_t level, uint32_t field, double* rms,
                                 double* max) {
  return withLog(log, [&]() -> qtet_status {
    if (const qtet_status status = log->needLevel(level)) return status;
    if (const qtet_status status = log->needField(field)) return status;
    if (const qtet_status status = log->needPlace(rms)) return status;
    if (const qtet_status status = log->needPlace(max)) return status;
    const auto& error = log->manifest.levels[level].error;
    if (!error)
      return log->refuse(QTET_NOT_FOUND,
                         "the log does not have the error of level " + std::to_string(level));
    *rms = error->fields[field].rms;
    *max = error->fields[field].max;
    return QTET_OK;
  });
}

qtet_status qtet_log_level_of_tetrahedra(qtet_log* log, uint64_t most, uint32_t* level) {
  return withLog(log, [&] { return answer(log, qtet::TetrahedraTarget{most}, level); });
}

qtet_status qtet_log_level_of_bytes(qtet_log* log, uint64_t most, uint32_t* level) {
  return withLog(log, [&] { return answer(log, qtet::BytesTarget{most}, level); });
}

qtet_status qtet_log_level_of_boundary_error(qtet_log* log, double bound, uint32_t* level) {
  return withLog(log, [&] {
    if (const qtet_status status = needBound(log, bound)) return status;
    return answer(log, qtet::BoundaryErrorTarget{bound}, level);
  });
}

qtet_status qtet_log_level_of_field_error(qtet_log* log, uint32_t field, double bound,
                                          uint32_t* level) {
  return withLog(log, [&] {
    if (const qtet_status status = log->needField(field)) return status;
    if (const qtet_status status = needBound(log, bound)) return status;
    return answer(log, qtet::FieldErrorTarget{bound, fieldKey(log->manifest, field)}, level);
  });
}
