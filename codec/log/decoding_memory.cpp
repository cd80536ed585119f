#include "codec/log/decoding_memory.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <map>
#include <numeric>
#include <vector>

#include "codec/log/last_uses.h"
#include "codec/log/log_index.h"
#include "codec/mesh/growing_mesh.h"
#include "codec/record/lifted_values.h"
#include "codec/record/point_values.h"
#include "proto/limits.h"

namespace qtet {
namespace {

// A vector that grows by doubling holds twice what is in it at most, and half as much again while
// it moves.
constexpr std::uint64_t kDoubling = 3;
// The probability models, twice, and other things of fixed size.
constexpr std::uint64_t kFixed = 1u << 20;
// For the base mesh only: the faces that are open while it is grown, and those that are paired up
// to find its boundary.
constexpr std::uint64_t kBaseTetrahedron = 300;
// A refiner's own figures of a chunk, beside its row of the table.
constexpr std::uint64_t kChunk = 128;
// An integer of a block: Draco's buffers, the digits behind it, and what comes out. Lifted blocks
// have no list of integers.
constexpr std::uint64_t kDracoInteger = 24, kAdaptiveInteger = 8;

std::uint64_t integerBytes(CodecId codec) {
  return codec == CodecId::kDraco      ? kDracoInteger
         : codec == CodecId::kAdaptive ? kAdaptiveInteger
                                       : 0;
}

struct Totals {
  Slots slots;
  std::uint64_t records = 0, structureBytes = 0, blockBytes = 0;
};

/// Sums over the chunks up to the one that completes the level.
Totals totalsOf(const LogIndex& index, std::uint32_t level, std::span<const std::uint32_t> fields) {
  Totals out;
  // A chunk has as many tuples for all fields of an association, so one of each counts.
  std::map<Association, std::uint32_t> widest;
  for (const std::uint32_t field : fields) {
    std::uint32_t& most = widest.emplace(index.fields[field].association, field).first->second;
    if (index.fields[field].components > index.fields[most].components) most = field;
  }
  for (std::uint32_t chunk = 0; chunk < index.chunks.size(); ++chunk) {
    const ChunkEntry& entry = index.chunks[chunk];
    out.slots.vertices += entry.newVertices;
    out.slots.tetrahedra += entry.newTetrahedra;
    out.slots.triangles += entry.newBoundaryTriangles;
    out.records += entry.records;
    out.structureBytes += entry.blocks[kStructurePart].size;
    const auto bytes = [&](std::uint32_t part) {
      return integerBytes(index.blockCodec(chunk, part)) * index.components(part) *
             index.tuples(chunk, part);
    };
    std::uint64_t largest = 0;
    for (const auto& [association, field] : widest)
      largest = std::max(largest, bytes(kFirstFieldPart + field));
    out.blockBytes = std::max(out.blockBytes, bytes(kPositionsPart) + largest);
    if (entry.lastLevel >= level) break;
  }
  return out;
}

bool isLifted(const LogIndex& index, std::uint32_t field) {
  return index.blockCodec(0, kFirstFieldPart + field) == CodecId::kLifted;
}

/// One field's values, its differences, and the sizes that lifted blocks keep.
std::uint64_t bytesOf(const LogIndex& index, std::uint32_t number, const Slots& slots) {
  const FieldShape& field = index.fields[number];
  const bool ofPoints = field.association == Association::kPoint;
  const std::uint64_t values =
      std::uint64_t{field.components} * (ofPoints ? slots.vertices : slots.tetrahedra);
  return values * (sizeof(std::int32_t) * (field.prediction.isNone() ? 1 : 2) +
                   (isLifted(index, number) ? 1 : 0));
}

/// The models of the lifted block in hand.
std::uint64_t modelBytes(const LogIndex& index, std::span<const std::uint32_t> fields) {
  std::size_t most = 0;
  for (const std::uint32_t field : fields)
    if (isLifted(index, field))
      most = std::max(most, liftedModelBytes(index.fields[field].components));
  return most;
}

/// The most of them at a time, one after the other.
std::uint64_t mostAtATime(const LogIndex& index, const Slots& slots,
                          std::span<const std::uint32_t> fields) {
  const std::vector<std::vector<std::uint32_t>> uses = lastUses(index.fields, fields);
  std::uint64_t now = 0, most = 0;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    now += bytesOf(index, fields[i], slots);
    most = std::max(most, now);
    for (const std::uint32_t ended : uses[i]) now -= bytesOf(index, ended, slots);
  }
  return most;
}

std::uint64_t fieldBytes(const LogIndex& index, const Slots& slots,
                         std::span<const std::uint32_t> fields, FieldsHeld held) {
  std::uint64_t sum = 0, largest = 0;
  for (const std::uint32_t field : fields) {
    const std::uint64_t bytes = bytesOf(index, field, slots);
    sum += bytes;
    largest = std::max(largest, bytes);
  }
  if (held == FieldsHeld::kOneByOne) sum = mostAtATime(index, slots, fields);
  const std::uint64_t ancestry =
      index.hasCellField() ? sizeof(std::array<CellId, 4>) * std::uint64_t{slots.tetrahedra} : 0;
  return (kDoubling - 1) * sum + largest + kDoubling * ancestry;
}

}  // namespace

std::uint64_t decodingBytes(const LogIndex& index) {
  std::vector<std::uint32_t> all(index.fields.size());
  std::iota(all.begin(), all.end(), 0u);
  return decodingBytes(index, index.chunks.back().lastLevel, all, FieldsHeld::kAll);
}

std::uint64_t decodingBytes(const LogIndex& index, std::uint32_t level,
                            std::span<const std::uint32_t> fields, FieldsHeld held) {
  assert(level <= index.chunks.back().lastLevel);
  assert(fields.empty() || fields.back() < index.fields.size());
  const std::vector<std::uint32_t> needed =
      withParents(index.fields, {fields.begin(), fields.end()});
  const Totals all = totalsOf(index, level, needed);
  const bool withPointField = std::ranges::any_of(
      index.fields, [](const FieldShape& f) { return f.association == Association::kPoint; });
  const std::uint64_t mesh = GrowingMesh::roomFor(all.slots) +
                             PointAncestry(withPointField).roomFor(all.records, all.slots.vertices);
  // A refiner that goes to the end reserves room for all elements at once if their number is
  // credible for so few bytes. Otherwise it lets its arrays grow.
  const bool roomy = level >= index.chunks.back().lastLevel &&
                     std::max({all.slots.vertices, all.slots.tetrahedra, all.slots.triangles}) <=
                         kMaxElementsPerByte * all.structureBytes;
  const std::uint64_t table =
      index.chunks.size() * (sizeof(ChunkEntry) + kChunk + index.parts() * sizeof(BlockEntry)) +
      index.manifest.size() + index.laterManifest.size();
  return kFixed + table + (roomy ? 1 : kDoubling) * mesh +
         kBaseTetrahedron * index.chunks.front().newTetrahedra +
         fieldBytes(index, all.slots, needed, held) + all.blockBytes + modelBytes(index, needed);
}

}  // namespace qtet
