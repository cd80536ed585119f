#include "codec/log/chunk_writer.h"

#include <bit>
#include <cassert>
#include <cstdlib>
#include <utility>

#include "codec/log/value_block.h"
#include "proto/crc32c.h"
#include "proto/limits.h"

namespace qtet {
namespace {

// Draco takes about log2 of a residual's magnitude and two bits more.
constexpr std::uint64_t kMoreBits = 2;

std::uint64_t bitsOf(std::int32_t value) {
  return static_cast<std::uint64_t>(std::bit_width(static_cast<std::uint32_t>(std::abs(value))));
}

}  // namespace

void ChunkWriter::endRecord(std::uint64_t fieldBits) {
  ++row_.records;
  fieldBits_ += fieldBits;
  const std::vector<std::int32_t>& written = positions_.written();
  for (; seen_ < written.size(); ++seen_) positionBits_ += kMoreBits + bitsOf(written[seen_]);
}

// The estimate of the positions, corrected by how far it was off in the chunks before.
std::uint64_t ChunkWriter::estimatedBytes() const {
  return structure_.size() +
         positionBits_ / 8 * (1 + closedPositionBytes_) / (1 + closedPositionBits_ / 8) +
         fieldBits_ / 8;
}

Status ChunkWriter::close(std::uint32_t lastLevel, std::uint32_t endSlot, const Slots& end) {
  assert(row_.firstLevel <= lastLevel && lastLevel <= kMaxLevels);
  assert(first_.vertices <= end.vertices && first_.tetrahedra <= end.tetrahedra);
  assert(first_.triangles <= end.triangles);
  row_.lastLevel = lastLevel;
  row_.endSlot = endSlot;
  row_.newVertices = end.vertices - first_.vertices;
  row_.newTetrahedra = end.tetrahedra - first_.tetrahedra;
  row_.newBoundaryTriangles = end.triangles - first_.triangles;
  row_.valueCodec = valueCodec_;
  Bytes blocks = structure_.finish();
  if (Status s = addBlock(row_, blocks); !s) return s;
  const Result<Bytes> positions =
      encodeValueBlock(positions_.written(), 3, positionCodec(valueCodec_));
  if (!positions) return std::unexpected(positions.error());
  if (Status s = addBlock(row_, *positions); !s) return s;
  blocks.insert(blocks.end(), positions->begin(), positions->end());
  closedBytes_ += blocks.size() + std::exchange(fieldBits_, 0) / 8;
  const std::uint64_t positionBits = std::exchange(positionBits_, 0);
  if (!rows_.empty()) {
    closedPositionBytes_ += positions->size();
    closedPositionBits_ += positionBits;
  }
  positions_.written().clear();
  seen_ = 0;
  geometry_.push_back(std::move(blocks));
  rows_.push_back(std::exchange(row_, ChunkEntry{}));
  first_ = end;
  return {};
}

Status ChunkWriter::addBlock(ChunkEntry& row, ByteView block) {
  if (block.size() > kMaxBlockBytes)
    return fail(ErrorCode::kLimitExceeded,
                "a block above 256 MiB; let the simplifier go further (`targetRatio`)");
  row.blocks.push_back({0, static_cast<std::uint32_t>(block.size()), crc32c(block)});
  return {};
}

}  // namespace qtet
