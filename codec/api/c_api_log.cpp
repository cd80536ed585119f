// codec/api/qtet.h: opening a log, and what it holds.
#include <algorithm>
#include <cstddef>
#include <cstring>
#include <span>
#include <utility>

#include "codec/api/c_api_handle.h"
#include "codec/log/log_levels.h"
#include "codec/log/log_manifest.h"
#include "codec/refine/refiner.h"
#include "proto/field_key.h"
#include "proto/level_error_json.h"
#include "proto/limits.h"
#include "proto/rounding_error.h"

using qtet::Bytes;
using qtet::ByteView;
using qtet::ErrorCode;
using qtet::guarded;
using qtet::LogFile;
using qtet::Manifest;
using qtet::ManifestField;
using qtet::ManifestLevel;
using qtet::Result;
using qtet::withLog;

namespace {

/// `path` is "" for a log from memory.
qtet_status take(qtet_log* log, Result<LogFile> file, const std::string& path) {
  if (!file) return log->refuse(file.error());
  Result<Manifest> manifest = qtet::manifestOf(file->index());
  if (!manifest) {
    if (!path.empty()) manifest.error().message = path + ": " + manifest.error().message;
    return log->refuse(manifest.error());
  }
  log->manifest = std::move(*manifest);
  for (const ManifestField& field : log->manifest.fields)
    log->units.emplace_back(qtet::unitOf(log->manifest, field.name));
  log->units.emplace_back(qtet::timeUnit(log->manifest));
  for (const auto& [name, values] : log->manifest.labels)
    log->labels[name] = qtet::toJson(values).dump();
  log->file = std::move(*file);
  return QTET_OK;
}

void close(qtet_log* log) {
  log->refiner.reset();
  log->file.reset();
  log->manifest = {};
  log->units.clear();
  log->labels.clear();
}

/// Bytes of the structs' first versions: to the end of their last member. No caller has fewer.
template <class Info>
constexpr std::size_t kFirstBytes = 0;
template <>
constexpr std::size_t kFirstBytes<qtet_log_info> =
    offsetof(qtet_log_info, generator) + sizeof(qtet_log_info::generator);
template <>
constexpr std::size_t kFirstBytes<qtet_field_info> =
    offsetof(qtet_field_info, type) + sizeof(qtet_field_info::type);
template <>
constexpr std::size_t kFirstBytes<qtet_series_info> =
    offsetof(qtet_series_info, name) + sizeof(qtet_series_info::name);
template <>
constexpr std::size_t kFirstBytes<qtet_level_info> =
    offsetof(qtet_level_info, volumeKept) + sizeof(qtet_level_info::volumeKept);

/// A caller built against an earlier version has a shorter struct and gets only that much. A later
/// one has a longer struct; the members that this library does not know become 0.
template <class Info>
qtet_status give(qtet_log* log, const Info& info, std::size_t infoBytes, Info* out) {
  if (out == nullptr) return log->refuse(QTET_BAD_ARGUMENT, "info is null");
  if (infoBytes < kFirstBytes<Info>)
    return log->refuse(QTET_BAD_ARGUMENT, "info has " + std::to_string(infoBytes) +
                                              " bytes, it needs " + std::to_string(sizeof(Info)) +
                                              "; pass sizeof");
  std::memset(static_cast<void*>(out), 0, infoBytes);
  std::memcpy(out, &info, std::min(infoBytes, sizeof(Info)));
  return QTET_OK;
}

/// FORMAT.md, "Header".
std::uint32_t versionPart(ByteView header, std::size_t offset) {
  return header[offset] | std::uint32_t{header[offset + 1]} << 8;
}

qtet_log_info infoOf(const qtet_log& log) {
  const LogFile& file = *log.file;
  qtet_log_info info{};
  info.versionMajor = versionPart(file.bytes(), 8);
  info.versionMinor = versionPart(file.bytes(), 10);
  info.bytes = file.bytes().size();
  info.chunks = static_cast<std::uint32_t>(file.chunks().size());
  info.levels = static_cast<std::uint32_t>(log.manifest.levels.size());
  info.fields = static_cast<std::uint32_t>(log.manifest.fields.size());
  info.latticeBits = static_cast<std::uint32_t>(log.manifest.latticeBits);
  info.latticeStep = log.manifest.latticeStep;
  for (std::size_t axis = 0; axis < 3; ++axis)
    info.latticeOrigin[axis] = log.manifest.latticeOrigin[axis];
  info.digest = file.digest().c_str();
  info.source = log.manifest.source.c_str();
  info.generator = log.manifest.generator.c_str();
  info.timeUnit = log.units.back().c_str();
  return info;
}

std::uint32_t associationOf(const auto& fieldOrSeries) {
  return fieldOrSeries.association == "cell" ? QTET_CELL : QTET_POINT;
}

qtet_field_info infoOfField(const qtet_log& log, std::uint32_t field) {
  const ManifestField& f = log.manifest.fields[field];
  qtet_field_info info{};
  info.components = f.components;
  info.association = associationOf(f);
  info.bits = static_cast<std::uint32_t>(f.bits);
  info.step = f.step;
  for (std::size_t c = 0; c < f.components; ++c) info.minimum[c] = f.minimum[c];
  info.range[0] = f.range[0];
  info.range[1] = f.range[1];
  for (const qtet::ChunkEntry& chunk : log.file->chunks())
    info.bytes += chunk.blocks[qtet::kFirstFieldPart + field].size;
  info.name = f.name.c_str();
  info.type = f.type.c_str();
  info.unit = log.units[field].c_str();
  info.largestRoundingError = qtet::largestRoundingError(f);
  info.labels = "";
  if (qtet::labelNamesOf(log.manifest, field) != nullptr)
    info.labels = log.labels.find(f.name.withoutTime())->second.c_str();
  return info;
}

qtet_level_info infoOfLevel(const qtet_log& log, std::uint32_t level) {
  const ManifestLevel& l = log.manifest.levels[level];
  qtet_level_info info{};
  info.tetrahedra = l.tetrahedra;
  info.vertices = l.vertices;
  info.boundaryTriangles = l.boundaryTriangles;
  info.prefixBytes = qtet::prefixBytes(log.manifest, log.file->index(), level);
  if (!l.error) return info;
  info.hasError = 1;
  info.boundaryDistance = l.error->boundaryDistance();
  info.toLevelMean = l.error->toLevel.mean;
  info.toLevelMax = l.error->toLevel.max;
  info.toOriginalMean = l.error->toOriginal.mean;
  info.toOriginalMax = l.error->toOriginal.max;
  info.volumeKept = 1 - l.error->volumeLost + l.error->volumeGained;
  info.volumeLost = l.error->volumeLost;
  info.volumeGained = l.error->volumeGained;
  return info;
}

}  // namespace

// The border's numbers are for ever, so they do not follow ErrorCode's order.
qtet_status qtet::statusOf(ErrorCode code) {
  switch (code) {
    case ErrorCode::kTruncated: return QTET_TRUNCATED;
    case ErrorCode::kBadMagic: return QTET_BAD_MAGIC;
    case ErrorCode::kBadVersion: return QTET_BAD_VERSION;
    case ErrorCode::kBadChecksum: return QTET_BAD_CHECKSUM;
    case ErrorCode::kBadValue: return QTET_BAD_VALUE;
    case ErrorCode::kLimitExceeded: return QTET_LIMIT_EXCEEDED;
    case ErrorCode::kBadCodec: return QTET_BAD_CODEC;
    case ErrorCode::kBadOrder: return QTET_BAD_ORDER;
    case ErrorCode::kNotFound: return QTET_NOT_FOUND;
    case ErrorCode::kBadInput: return QTET_BAD_INPUT;
    case ErrorCode::kIo: return QTET_IO;
    case ErrorCode::kCancelled: return QTET_CANCELLED;
  }
  return QTET_INTERNAL;
}

static_assert(QTET_MAX_COMPONENTS == qtet::kMaxFieldComponents);

qtet_status qtet::Failure::refuse(const Error& error) {
  message = error.text();
  text = message.c_str();
  return statusOf(error.code);
}

qtet_status qtet_log::needField(std::uint32_t field) {
  const std::size_t fields = manifest.fields.size();
  return field < fields ? QTET_OK
                        : refuse(QTET_NOT_FOUND, "there is no field " + std::to_string(field) +
                                                     "; the log has " + std::to_string(fields));
}

qtet_status qtet_log::needLevel(std::uint32_t level) {
  const std::size_t last = manifest.levels.size() - 1;
  return level <= last ? QTET_OK
                       : refuse(QTET_NOT_FOUND, "there is no level " + std::to_string(level) +
                                                    "; the last is " + std::to_string(last));
}

qtet_status qtet_log::needSeries(std::uint32_t number) {
  return number < manifest.series.size()
             ? QTET_OK
             : refuse(QTET_NOT_FOUND, "there is no series " + std::to_string(number) +
                                          "; the log has " +
                                          std::to_string(manifest.series.size()));
}

qtet_log* qtet_log_create() { return new (std::nothrow) qtet_log; }
void qtet_log_destroy(qtet_log* log) { delete log; }
const char* qtet_log_error(const qtet_log* log) {
  return log != nullptr ? log->text : "bad-argument: the log is null";
}

qtet_status qtet_log_open_file(qtet_log* log, const char* path) {
  return guarded(log, [&] {
    close(log);
    return path != nullptr ? take(log, LogFile::open(path), path)
                           : log->refuse(QTET_BAD_ARGUMENT, "the path is null");
  });
}

qtet_status qtet_log_open_memory(qtet_log* log, size_t bytes, const void* data) {
  return guarded(log, [&]() -> qtet_status {
    close(log);
    if (data == nullptr) return log->refuse(QTET_BAD_ARGUMENT, "data is null");
    const auto* first = static_cast<const std::uint8_t*>(data);
    return take(log, LogFile::fromBytes(Bytes(first, first + bytes)), "");
  });
}

qtet_status qtet_log_verify(qtet_log* log) {
  return withLog(log, [&]() -> qtet_status {
    const qtet::Status status = log->file->verifyChecksums();
    return status ? QTET_OK : log->refuse(status.error());
  });
}

qtet_status qtet_log_get_info(qtet_log* log, size_t infoBytes, qtet_log_info* info) {
  return withLog(log, [&] { return give(log, infoOf(*log), infoBytes, info); });
}

qtet_status qtet_log_get_field(qtet_log* log, uint32_t field, size_t infoBytes,
                               qtet_field_info* info) {
  return withLog(log, [&] {
    if (const qtet_status status = log->needField(field)) return status;
    return give(log, infoOfField(*log, field), infoBytes, info);
  });
}

qtet_status qtet_log_get_level(qtet_log* log, uint32_t level, size_t infoBytes,
                               qtet_level_info* info) {
  return withLog(log, [&] {
    if (const qtet_status status = log->needLevel(level)) return status;
    return give(log, infoOfLevel(*log, level), infoBytes, info);
  });
}

qtet_status qtet_log_find_field(qtet_log* log, const char* name, uint32_t* field) {
  return withLog(log, [&]() -> qtet_status {
    if (name == nullptr || field == nullptr)
      return log->refuse(QTET_BAD_ARGUMENT, "the name or the place for the answer is null");
    const auto found = qtet::fieldOfKey(log->manifest, name);
    if (found) {
      *field = *found;
      return QTET_OK;
    }
    return log->refuse(qtet::noSuchField(log->manifest, name));
  });
}

uint32_t qtet_log_series_count(const qtet_log* log) {
  return log != nullptr ? static_cast<std::uint32_t>(log->manifest.series.size()) : 0;
}

qtet_status qtet_log_get_series(qtet_log* log, uint32_t series, size_t infoBytes,
                                qtet_series_info* info) {
  return withLog(log, [&] {
    if (const qtet_status status = log->needSeries(series)) return status;
    const qtet::Series& found = log->manifest.series[series];
    return give(
        log,
        qtet_series_info{associationOf(found), static_cast<std::uint32_t>(found.fields.size()),
                         found.name.c_str()},
        infoBytes, info);
  });
}

qtet_status qtet_log_copy_series(qtet_log* log, uint32_t series, size_t count, double* times,
                                 uint32_t* fields) {
  return withLog(log, [&]() -> qtet_status {
    if (const qtet_status status = log->needSeries(series)) return status;
    const qtet::Series& found = log->manifest.series[series];
    if (count < found.times.size())
      return log->refuse(QTET_BAD_ARGUMENT, "the arrays have room for " + std::to_string(count) +
                                                " instants, the series has " +
                                                std::to_string(found.times.size()));
    if (times != nullptr) std::ranges::copy(found.times, times);
    if (fields != nullptr)
      std::ranges::transform(found.fields, fields,
                             [](std::size_t f) { return static_cast<std::uint32_t>(f); });
    return QTET_OK;
  });
}
