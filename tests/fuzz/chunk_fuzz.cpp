// Fuzzes the whole way from bytes to a mesh: the input is a log. Header checksums are made right
// and block checksums not looked at, so that Draco and the refiner meet every damage. Logs that
// promise much are left to other tests: this one shall be fast.
#include <cstdint>
#include <vector>

#include "codec/log/log_manifest.h"
#include "codec/log/value_block.h"
#include "codec/refine/refiner.h"
#include "tests/fuzz/checked_refiner.h"
#include "tests/support/forged_log.h"

namespace {

constexpr std::uint64_t kMaxNumbers = 1 << 18;

std::uint64_t promised(const qtet::LogIndex& index) {
  std::uint64_t out = 0;
  for (std::uint32_t c = 0; c < index.chunks.size(); ++c) {
    out +=
        4 * (std::uint64_t{index.chunks[c].newTetrahedra} + index.chunks[c].newBoundaryTriangles);
    for (std::uint32_t part = qtet::kPositionsPart; part < index.parts(); ++part)
      out += std::uint64_t{index.tuples(c, part)} * index.components(part);
  }
  return out;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  qtet::Bytes bytes(data, data + size);
  qtet::testing::mendChecksums(bytes);
  const auto index = qtet::LogIndex::parse(bytes);
  if (!index || promised(*index) > kMaxNumbers) return 0;
  (void)qtet::manifestOf(*index);
  qtet::Refiner refiner(*index);
  const auto block = [&](std::uint32_t chunk, std::uint32_t part) {
    const qtet::BlockEntry& b = index->block(chunk, part);
    return b.offset + b.size <= bytes.size()
               ? qtet::ByteView(bytes).subspan(static_cast<std::size_t>(b.offset), b.size)
               : qtet::ByteView();
  };
  const auto values = [&](std::uint32_t chunk, std::uint32_t part) {
    return qtet::decodeValueBlock(block(chunk, part), index->components(part),
                                  index->tuples(chunk, part), index->blockCodec(chunk, part));
  };
  const auto isApplied = [&](std::uint32_t chunk, std::uint32_t f) {
    const std::uint32_t part = qtet::kFirstFieldPart + f;
    if (index->blockCodec(chunk, part) == qtet::CodecId::kLifted)
      return refiner.applyField(f, chunk, block(chunk, part)).has_value();
    const auto field = values(chunk, part);
    return field && refiner.applyField(f, chunk, *field);
  };
  for (std::uint32_t chunk = 0; chunk < index->chunks.size(); ++chunk) {
    const auto positions = values(chunk, qtet::kPositionsPart);
    if (!positions || !refiner.apply(chunk, block(chunk, qtet::kStructurePart), *positions)) break;
    for (std::uint32_t f = 0; f < index->fields.size(); ++f)
      if (isApplied(chunk, f)) qtet::fuzz::abortUnlessWhole(refiner, f);
  }
  qtet::fuzz::abortUnlessSound(refiner);
  return 0;
}
