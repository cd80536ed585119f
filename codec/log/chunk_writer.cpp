#include "codec/log/chunk_writer.h"

#include <bit>
#include <cstdlib>
#include <utility>

#include "codec/log/value_block.h"
#include "proto/crc32c.h"
#include "proto/limits.h"
#include "proto/series.h"

namespace qtet {
namespace {

// Draco takes about log2 of a residual's magnitude and two bits more; cells' values are often
// their prediction.
constexpr std::uint64_t kMoreBits = 2;

std::uint64_t bitsOf(std::int32_t value) {
  return static_cast<std::uint64_t>(std::bit_width(static_cast<std::uint32_t>(std::abs(value))));
}

}  // namespace

ChunkWriter::ChunkWriter(std::span<const FieldInfo> fields, CodecId valueCodec, ByteSink body)
    : fields_(fields),
      valueCodec_(valueCodec),
      body_(std::move(body)),
      counts_(1 + fields.size(), true) {
  open_.values.resize(1 + fields.size());
  open_.seen.resize(1 + fields.size());
  const std::vector<bool> isLater = laterInstants(fields);
  for (std::size_t f = 0; f < fields.size(); ++f) counts_[1 + f] = !isLater[f];
}

void ChunkWriter::endRecord() {
  ++open_.row.records;
  for (std::size_t part = 0; part < open_.values.size(); ++part) {
    if (!counts_[part]) continue;
    const std::uint64_t more = part > 0 && isCellField(fields_[part - 1]) ? 0 : kMoreBits;
    const std::vector<std::int32_t>& written = open_.values[part].written();
    for (std::size_t& i = open_.seen[part]; i < written.size(); ++i)
      open_.valueBits += more + bitsOf(written[i]);
  }
}

// The estimate of the values, corrected by how far it was off in the chunks before.
std::uint64_t ChunkWriter::estimatedBytes() const {
  return open_.structure.size() + open_.valueBits / 8 * (1 + valueBytes_) / (1 + valueBits_ / 8);
}

Status ChunkWriter::close(std::uint32_t lastLevel, std::uint32_t endSlot, const Slots& end) {
  ChunkEntry& row = open_.row;
  row.lastLevel = lastLevel;
  row.endSlot = endSlot;
  row.newVertices = end.vertices - open_.first.vertices;
  row.newTetrahedra = end.tetrahedra - open_.first.tetrahedra;
  row.newBoundaryTriangles = end.triangles - open_.first.triangles;
  row.valueCodec = valueCodec_;
  if (Status s = addBlock(open_.structure.finish()); !s) return s;
  closedBytes_ += row.blocks.front().size;
  std::uint64_t valueBytes = 0;
  for (std::size_t part = 0; part < open_.values.size(); ++part) {
    std::vector<std::int32_t>& written = open_.values[part].written();
    const Result<Bytes> block =
        encodeValueBlock(written, part == 0 ? 3 : fields_[part - 1].components, valueCodec_);
    if (!block) return std::unexpected(block.error());
    if (Status s = addBlock(*block); !s) return s;
    if (counts_[part]) valueBytes += block->size();
    written.clear();
    open_.seen[part] = 0;
  }
  closedBytes_ += valueBytes;
  const std::uint64_t valueBits = std::exchange(open_.valueBits, 0);
  if (!rows_.empty()) {
    valueBytes_ += valueBytes;
    valueBits_ += valueBits;
  }
  rows_.push_back(std::exchange(row, ChunkEntry{}));
  open_.first = end;
  return {};
}

Status ChunkWriter::addBlock(const Bytes& block) {
  if (block.size() > kMaxBlockBytes)
    return fail(ErrorCode::kLimitExceeded,
                "a block above 256 MiB; let the simplifier go further (`targetRatio`)");
  open_.row.blocks.push_back({0, static_cast<std::uint32_t>(block.size()), crc32c(block)});
  return body_(block);
}

}  // namespace qtet
