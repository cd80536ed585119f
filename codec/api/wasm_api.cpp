#include "codec/api/wasm_api.h"

#include <cstdlib>
#include <cstring>
#include <optional>
#include <string>

#include "codec/coding/adaptive_block.h"
#include "codec/coding/level_columns.h"
#include "codec/coding/value_digits.h"
#include "codec/log/codec_id.h"
#include "codec/log/log_index.h"
#include "codec/refine/refiner.h"
#include "proto/crc32c.h"
#include "proto/limits.h"

using qtet::ByteView;
using qtet::Error;
using qtet::ErrorCode;
using qtet::LogIndex;

#if defined(__wasm__)
// libc++ and libc++abi call these when they give up. Their own versions bring all of printf.
extern "C" [[noreturn]] void abort_message(const char*, ...) { __builtin_trap(); }
_LIBCPP_BEGIN_NAMESPACE_STD
void __libcpp_verbose_abort(const char*, ...) { __builtin_trap(); }
_LIBCPP_END_NAMESPACE_STD
#endif

namespace {

// One module instance is one refiner: a page that shows two logs makes two instances.
std::optional<qtet::Refiner> refiner;
std::string lastError;
qtet::LevelColumns levelNumbers;

int report(const Error& error) {
  lastError = error.text();
  return 1 + static_cast<int>(error.code);
}

bool hasBlock(std::uint32_t chunk, std::uint32_t part) {
  return refiner && chunk < refiner->index().chunks.size() && part < refiner->index().parts();
}

qtet::Result<std::vector<std::int32_t>> blockValues(std::uint32_t chunk, std::uint32_t part,
                                                    std::span<const std::int32_t> symbols,
                                                    ByteView digits) {
  const LogIndex& index = refiner->index();
  if (hasBlock(chunk, part) && index.blockCodec(chunk, part) == qtet::CodecId::kAdaptive)
    return qtet::decodeAdaptiveBlock(digits, index.components(part), index.tuples(chunk, part));
  return qtet::joinValues(symbols, digits);
}

int noLog() { return report({ErrorCode::kBadOrder, "no log is open: call qtet_open first"}); }

bool hasField(std::uint32_t field) { return refiner && field < refiner->index().fields.size(); }

}  // namespace

extern "C" {

void* qtet_alloc(std::uint32_t bytes) { return std::malloc(bytes); }
void qtet_free(void* memory) { std::free(memory); }

int qtet_open(const std::uint8_t* head, std::uint32_t bytes) {
  refiner.reset();
  auto index = LogIndex::parseHead(ByteView(head, bytes));
  if (!index) return report(index.error());
  refiner.emplace(std::move(*index));
  return 0;
}

std::uint32_t qtet_later_bytes() { return refiner ? refiner->index().unreadBytes() : 0; }

int qtet_read_later(const std::uint8_t* part, std::uint32_t bytes) {
  if (qtet_later_bytes() == 0)
    return report({ErrorCode::kBadOrder, "the open log has no later instants to be read"});
  const qtet::Status read = refiner->readLater(ByteView(part, bytes));
  return read ? 0 : report(read.error());
}

const char* qtet_error() { return lastError.c_str(); }

std::uint32_t qtet_chunk_count() {
  return refiner ? static_cast<std::uint32_t>(refiner->index().chunks.size()) : 0;
}

std::uint32_t qtet_level_count() {
  return refiner ? refiner->index().chunks.back().lastLevel + 1 : 0;
}

int qtet_level_columns(const std::uint8_t* bytes, std::uint32_t size, std::uint32_t errors,
                       std::uint32_t fields) {
  if (!refiner) return noLog();
  if (fields > qtet::kMaxFields)
    return report({ErrorCode::kLimitExceeded, "more fields than a log may have"});
  if (errors > static_cast<std::uint32_t>(qtet::KnownErrors::kSome))
    return report({ErrorCode::kBadValue, std::to_string(errors) + " is no kind of known errors"});
  auto numbers = qtet::decodeLevelColumns(ByteView(bytes, size), qtet_level_count(), fields,
                                          static_cast<qtet::KnownErrors>(errors));
  if (!numbers) return report(numbers.error());
  levelNumbers = std::move(*numbers);
  return 0;
}
const std::uint32_t* qtet_level_numbers() { return levelNumbers.data(); }

double qtet_block_offset(std::uint32_t chunk, std::uint32_t part) {
  return hasBlock(chunk, part) ? static_cast<double>(refiner->index().block(chunk, part).offset)
                               : 0;
}
std::uint32_t qtet_block_size(std::uint32_t chunk, std::uint32_t part) {
  return hasBlock(chunk, part) ? refiner->index().block(chunk, part).size : 0;
}
std::uint32_t qtet_block_values(std::uint32_t chunk, std::uint32_t part) {
  return hasBlock(chunk, part) ? refiner->index().tuples(chunk, part) : 0;
}
std::uint32_t qtet_field_association(std::uint32_t field) {
  return hasField(field) ? static_cast<std::uint32_t>(refiner->index().fields[field].association)
                         : 0;
}
std::uint32_t qtet_field_parents(std::uint32_t field) {
  return hasField(field) ? refiner->index().fields[field].prediction.count : 0;
}
std::uint32_t qtet_field_parent(std::uint32_t field, std::uint32_t parent) {
  return parent < qtet_field_parents(field)
             ? refiner->index().fields[field].prediction.parents[parent].field
             : 0;
}
std::uint32_t qtet_block_codec(std::uint32_t chunk, std::uint32_t part) {
  if (!hasBlock(chunk, part)) return 0;
  return static_cast<std::uint32_t>(refiner->index().blockCodec(chunk, part));
}

const std::uint32_t* qtet_chunk_brings(std::uint32_t chunk) {
  static std::uint32_t counts[3];
  if (!hasBlock(chunk, qtet::kStructurePart)) return nullptr;
  const qtet::ChunkEntry& e = refiner->index().chunks[chunk];
  counts[0] = e.newTetrahedra;
  counts[1] = e.newVertices;
  counts[2] = e.newBoundaryTriangles;
  return counts;
}

int qtet_check_block(std::uint32_t chunk, std::uint32_t part, const std::uint8_t* bytes,
                     std::uint32_t size) {
  if (!hasBlock(chunk, part)) return report({ErrorCode::kNotFound, "there is no such block"});
  const qtet::BlockEntry& b = refiner->index().block(chunk, part);
  if (size == b.size && qtet::crc32c(ByteView(bytes, size)) == b.crc) return 0;
  return report(
      {ErrorCode::kBadChecksum,
       "chunk " + std::to_string(chunk) + ", part " + std::to_string(part) + " arrived damaged",
       b.offset});
}

int qtet_apply(std::uint32_t chunk, const std::uint8_t* structure, std::uint32_t size,
               const std::int32_t* symbols, std::uint32_t count, const std::uint8_t* digits,
               std::uint32_t digitBytes) {
  if (!refiner) return noLog();
  const auto positions = blockValues(chunk, qtet::kPositionsPart, std::span(symbols, count),
                                     ByteView(digits, digitBytes));
  if (!positions) return report(positions.error());
  const auto status = refiner->apply(chunk, ByteView(structure, size), *positions);
  return status ? 0 : report(status.error());
}

int qtet_apply_field(std::uint32_t field, std::uint32_t chunk, const std::int32_t* symbols,
                     std::uint32_t count, const std::uint8_t* digits, std::uint32_t digitBytes) {
  if (!refiner) return noLog();
  if (!hasField(field))
    return report({ErrorCode::kNotFound, "there is no field " + std::to_string(field)});
  const std::uint32_t part = qtet::kFirstFieldPart + field;
  if (hasBlock(chunk, part) && refiner->index().blockCodec(chunk, part) == qtet::CodecId::kLifted) {
    const auto status = refiner->applyField(field, chunk, ByteView(digits, digitBytes));
    return status ? 0 : report(status.error());
  }
  const auto values =
      blockValues(chunk, part, std::span(symbols, count), ByteView(digits, digitBytes));
  if (!values) return report(values.error());
  const auto status = refiner->applyField(field, chunk, *values);
  return status ? 0 : report(status.error());
}

std::uint32_t qtet_chunks_applied() { return refiner ? refiner->chunksApplied() : 0; }
std::uint32_t qtet_field_chunks_applied(std::uint32_t field) {
  return hasField(field) ? refiner->fieldChunksApplied(field) : 0;
}
std::uint32_t qtet_level() { return refiner ? refiner->level() : 0; }
std::uint32_t qtet_vertex_count() {
  return refiner ? static_cast<std::uint32_t>(refiner->points().size()) : 0;
}
std::uint32_t qtet_tetrahedron_count() {
  return refiner ? static_cast<std::uint32_t>(refiner->tetrahedra().size()) : 0;
}
std::uint32_t qtet_boundary_count() {
  return refiner ? static_cast<std::uint32_t>(refiner->boundary().size()) : 0;
}
const std::int32_t* qtet_points() {
  return refiner && !refiner->points().empty() ? refiner->points().data()->data() : nullptr;
}
const std::uint32_t* qtet_tetrahedra() {
  return refiner && !refiner->tetrahedra().empty() ? refiner->tetrahedra().data()->data() : nullptr;
}
const std::uint32_t* qtet_boundary() {
  return refiner && !refiner->boundary().empty() ? refiner->boundary().data()->data() : nullptr;
}
std::uint32_t qtet_across(std::uint32_t tetrahedron, std::uint32_t corner) {
  if (!refiner || tetrahedron >= refiner->tetrahedra().size() || corner > 3) return qtet::kGhost;
  return refiner->across(tetrahedron, corner).value_or(qtet::kGhost);
}
const std::int32_t* qtet_field(std::uint32_t field) {
  return qtet_field_chunks_applied(field) > 0 ? refiner->fieldValues(field).data() : nullptr;
}

void qtet_digest(std::uint8_t* out) {
  if (!refiner) return;
  const auto digest = refiner->digest();
  std::memcpy(out, digest.data(), digest.size());
}
}
