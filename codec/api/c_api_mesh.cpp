// codec/api/qtet.h: refining, and the arrays of the mesh.
#include <algorithm>
#include <cassert>
#include <cstring>
#include <limits>
#include <span>

#include "codec/api/c_api_handle.h"
#include "codec/refine/refiner.h"

using qtet::FieldShape;
using qtet::kMissing;
using qtet::Lattice;
using qtet::LatticePoint;
using qtet::LogFile;
using qtet::ManifestField;
using qtet::Refiner;
using qtet::Status;
using qtet::withLog;
using qtet::withMesh;

namespace {

/// Whether the refiner can go on to a level: not to a coarser one, and not when it had to stop
/// inside a chunk.
bool canGoOn(const LogFile& file, const Refiner& refiner, std::uint32_t level) {
  const std::uint32_t applied = refiner.chunksApplied();
  return refiner.level() == level ||
         (refiner.level() < level && file.chunks()[applied - 1].lastLevel == refiner.level());
}

Status refineTo(const LogFile& file, Refiner& refiner, std::uint32_t level) {
  refiner.stopAtLevel(level);
  while (refiner.chunksApplied() == 0 || refiner.level() < level)
    if (Status status = qtet::applyChunk(file, refiner, refiner.chunksApplied(), {}); !status)
      return status;
  return {};
}

/// Numbers of a field at the mesh's level. REQUIRES: a mesh and a field of the log.
std::size_t fieldCount(const qtet_log& log, std::uint32_t field) {
  assert(log.refiner && field < log.file->fields().size());
  const FieldShape& shape = log.file->fields()[field];
  const bool cells = shape.association == qtet::Association::kCell;
  return shape.components *
         (cells ? log.refiner->tetrahedra().size() : log.refiner->points().size());
}

/// Decodes what the field, and those that it is predicted from, lack of the mesh's chunks.
qtet_status catchUp(qtet_log* log, std::uint32_t field) {
  if (const qtet_status status = log->needField(field)) return status;
  for (const std::uint32_t f : qtet::withParents(log->file->fields(), std::span(&field, 1)))
    while (log->refiner->fieldChunksApplied(f) < log->refiner->chunksApplied()) {
      const Status status =
          qtet::applyFieldBlock(*log->file, *log->refiner, log->refiner->fieldChunksApplied(f), f);
      if (!status) return log->refuse(status.error());
    }
  return QTET_OK;
}

qtet_status needRoom(qtet_log* log, std::size_t count, std::size_t needed, const void* out) {
  if (out == nullptr) return log->refuse(QTET_BAD_ARGUMENT, "the array is null");
  if (count >= needed) return QTET_OK;
  return log->refuse(QTET_BAD_ARGUMENT, "the array has room for " + std::to_string(count) +
                                            " numbers, it needs " + std::to_string(needed));
}

template <class T>
qtet_status copyPoints(qtet_log* log, std::size_t count, T* out) {
  return withMesh(log, [&]() -> qtet_status {
    const std::span<const LatticePoint> points = log->refiner->points();
    if (const qtet_status status = needRoom(log, count, 3 * points.size(), out)) return status;
    const Lattice lattice{log->manifest.latticeBits, log->manifest.latticeStep,
                          log->manifest.latticeOrigin};
    for (const LatticePoint& point : points)
      for (const double x : lattice.position(point)) *out++ = static_cast<T>(x);
    return QTET_OK;
  });
}

template <class T>
qtet_status copyField(qtet_log* log, std::uint32_t field, std::size_t count, T* out) {
  return withMesh(log, [&]() -> qtet_status {
    if (const qtet_status status = log->needField(field)) return status;
    if (const qtet_status status = needRoom(log, count, fieldCount(*log, field), out))
      return status;
    if (const qtet_status status = catchUp(log, field)) return status;
    const ManifestField& f = log->manifest.fields[field];
    std::size_t component = 0;
    for (const std::int32_t integer : log->refiner->fieldValues(field)) {
      *out++ = integer == kMissing ? std::numeric_limits<T>::quiet_NaN()
                                   : static_cast<T>(f.minimum[component] + f.step * integer);
      component = component + 1 == f.components ? 0 : component + 1;
    }
    return QTET_OK;
  });
}

template <class Number, class Items>
const Number* numbersOf(const qtet_log* log, Items (Refiner::*items)() const) {
  if (log == nullptr || !log->refiner) return nullptr;
  const Items array = ((*log->refiner).*items)();
  return array.empty() ? nullptr : array.data()->data();
}

template <class Items>
std::uint32_t countOf(const qtet_log* log, Items (Refiner::*items)() const) {
  return log != nullptr && log->refiner
             ? static_cast<std::uint32_t>(((*log->refiner).*items)().size())
             : 0;
}

}  // namespace

qtet_status qtet_log_refine(qtet_log* log, uint32_t level) {
  return withLog(log, [&]() -> qtet_status {
    if (level == QTET_FULL) level = static_cast<std::uint32_t>(log->manifest.levels.size()) - 1;
    if (const qtet_status status = log->needLevel(level)) return status;
    // The log gets its refiner back only with a complete level; after an error it has none.
    std::optional<Refiner> refiner = std::move(log->refiner);
    log->refiner.reset();
    if (!refiner || !canGoOn(*log->file, *refiner, level)) refiner.emplace(log->file->index());
    if (const Status status = refineTo(*log->file, *refiner, level); !status)
      return log->refuse(status.error());
    log->refiner = std::move(refiner);
    return QTET_OK;
  });
}

uint32_t qtet_log_level(const qtet_log* log) {
  return log != nullptr && log->refiner ? log->refiner->level() : QTET_NO_LEVEL;
}
uint32_t qtet_log_vertex_count(const qtet_log* log) { return countOf(log, &Refiner::points); }
uint32_t qtet_log_tetrahedron_count(const qtet_log* log) {
  return countOf(log, &Refiner::tetrahedra);
}
uint32_t qtet_log_boundary_count(const qtet_log* log) { return countOf(log, &Refiner::boundary); }
const int32_t* qtet_log_lattice_points(const qtet_log* log) {
  return numbersOf<std::int32_t>(log, &Refiner::points);
}
const uint32_t* qtet_log_tetrahedra(const qtet_log* log) {
  return numbersOf<std::uint32_t>(log, &Refiner::tetrahedra);
}
const uint32_t* qtet_log_boundary(const qtet_log* log) {
  return numbersOf<std::uint32_t>(log, &Refiner::boundary);
}

qtet_status qtet_log_copy_points_double(qtet_log* log, size_t count, double* points) {
  return copyPoints(log, count, points);
}
qtet_status qtet_log_copy_points_float(qtet_log* log, size_t count, float* points) {
  return copyPoints(log, count, points);
}

size_t qtet_log_field_count(const qtet_log* log, uint32_t field) {
  return log != nullptr && log->refiner && field < log->manifest.fields.size()
             ? fieldCount(*log, field)
             : 0;
}
qtet_status qtet_log_copy_field_double(qtet_log* log, uint32_t field, size_t count,
                                       double* values) {
  return copyField(log, field, count, values);
}
qtet_status qtet_log_copy_field_float(qtet_log* log, uint32_t field, size_t count, float* values) {
  return copyField(log, field, count, values);
}

qtet_status qtet_log_field_integers(qtet_log* log, uint32_t field, const int32_t** integers) {
  return withMesh(log, [&]() -> qtet_status {
    if (const qtet_status status = log->needPlace(integers)) return status;
    *integers = nullptr;
    if (const qtet_status status = catchUp(log, field)) return status;
    *integers = log->refiner->fieldValues(field).data();
    return QTET_OK;
  });
}

qtet_status qtet_log_mesh_digest(qtet_log* log, uint8_t* digest) {
  return withMesh(log, [&]() -> qtet_status {
    if (const qtet_status status = log->needPlace(digest)) return status;
    const auto bytes = log->refiner->digest();
    std::memcpy(digest, bytes.data(), bytes.size());
    return QTET_OK;
  });
}
