// Fuzzes the refiner below checksums and Draco: the input stands for a table that makes few
// promises, for structure blocks and for residuals (tests/fuzz/seeds.cpp writes real logs in this
// form). Whatever happens, every id stays in range.
#include <cstdint>
#include <vector>

#include "codec/refine/refiner.h"
#include "tests/fuzz/byte_source.h"
#include "tests/fuzz/checked_refiner.h"

namespace {

constexpr std::uint32_t kMaxChunks = 8;

qtet::ChunkEntry entryFrom(qtet::fuzz::ByteSource& in, std::uint32_t chunk) {
  qtet::ChunkEntry e;
  e.newVertices = in.next16() % 1024;
  e.newTetrahedra = in.next16() % 4096;
  e.newBoundaryTriangles = in.next16() % 2048;
  e.records = in.next16() % 1024;
  e.firstLevel = in.next();
  e.lastLevel = e.firstLevel + in.next() % 4u;
  e.endSlot = in.next16();
  if (e.endSlot == 0xFFFF) e.endSlot = qtet::kLevelEnd;
  if (chunk == 0) e.firstLevel = e.lastLevel = 0;
  e.blocks.resize(4);
  return e;
}

std::vector<std::int32_t> valuesFrom(qtet::fuzz::ByteSource& in, std::size_t count) {
  std::vector<std::int32_t> out(count);
  for (std::int32_t& value : out) value = static_cast<std::int16_t>(in.next16());
  return out;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  qtet::fuzz::ByteSource in{{data, size}};
  qtet::LogIndex index;
  index.positionBits = 10;
  index.fields = {{2, qtet::Association::kPoint}, {1, qtet::Association::kCell}};
  const std::uint32_t chunks = 1 + in.next() % kMaxChunks;
  for (std::uint32_t c = 0; c < chunks; ++c) index.chunks.push_back(entryFrom(in, c));
  qtet::Refiner refiner(index);
  if (const std::uint8_t stop = in.next(); stop < 128) refiner.stopAtLevel(stop);
  bool whole[2] = {true, true};
  for (std::uint32_t c = 0; c < chunks; ++c) {
    const qtet::ByteView structure = in.take(in.next16());
    const auto status = refiner.apply(
        c, structure, valuesFrom(in, std::size_t{index.tuples(c, qtet::kPositionsPart)} * 3));
    qtet::fuzz::abortUnlessSound(refiner);
    if (!status) break;
    for (std::uint32_t f = 0; f < 2; ++f) {
      const std::uint32_t part = qtet::kFirstFieldPart + f;
      whole[f] &=
          refiner
              .applyField(
                  f, c, valuesFrom(in, std::size_t{index.tuples(c, part)} * index.components(part)))
              .has_value();
      if (whole[f]) qtet::fuzz::abortUnlessWhole(refiner, f);
    }
  }
  (void)refiner.digest();
  return 0;
}
