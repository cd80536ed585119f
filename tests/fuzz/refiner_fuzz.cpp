// Fuzzes the refiner below the checksums: the input stands for structure blocks and residuals of a log whose table makes few promises.
// Whatever happens, every id stays in range.
#include <cstdint>
#include <cstdlib>
#include <vector>

#include "codec/refiner.h"

namespace {

struct Source {
  qtet::ByteView bytes;
  std::uint8_t next() {
    if (bytes.empty()) return 0;
    const std::uint8_t b = bytes[0];
    bytes = bytes.subspan(1);
    return b;
  }
  qtet::ByteView take(std::size_t n) {
    const qtet::ByteView out = bytes.first(std::min(n, bytes.size()));
    bytes = bytes.subspan(out.size());
    return out;
  }
};

void checkIds(const qtet::Refiner& refiner) {
  const std::size_t n = refiner.points().size();
  for (const auto& t : refiner.tetrahedra())
    for (const auto v : t)
      if (v >= n) std::abort();
  for (const auto& t : refiner.boundary())
    for (const auto v : t)
      if (v >= n) std::abort();
}

qtet::ChunkEntry entryFrom(Source& in, std::uint32_t chunk, std::uint32_t& level) {
  qtet::ChunkEntry e;
  e.newVertices = in.next();
  e.newTetrahedra = in.next() + (in.next() << 8 & 0x300);
  e.newBoundaryTriangles = in.next();
  e.values = chunk == 0 ? e.newVertices : in.next();
  if (chunk > 0) {
    e.records = in.next();
    e.firstLevel = level;
    e.lastLevel = level + in.next() % 4;
    e.endSlot = in.next() % 2 ? qtet::kLevelEnd : in.next();
    level = e.lastLevel + (e.endSlot == qtet::kLevelEnd);
  }
  e.blocks.resize(4);
  return e;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Source in{{data, size}};
  qtet::LogIndex index;
  index.positionBits = 10;
  index.fields = {{2, qtet::Association::kPoint}, {1, qtet::Association::kCell}};
  std::uint32_t level = 1;
  for (std::uint32_t c = 0; c < 4; ++c) index.chunks.push_back(entryFrom(in, c, level));
  index.chunks[0].firstLevel = index.chunks[0].lastLevel = 0;
  qtet::Refiner refiner(index);
  for (std::uint32_t c = 0; c < index.chunks.size(); ++c) {
    const std::size_t structure = in.next();
    std::vector<std::int32_t> positions(std::size_t{index.chunks[c].values} * 3);
    for (auto& p : positions) p = static_cast<std::int8_t>(in.next()) * (in.next() % 2 ? 1 : 1000);
    const auto status = refiner.apply(c, in.take(structure), positions);
    checkIds(refiner);
    if (!status) break;
    for (std::uint32_t f = 0; f < index.fields.size(); ++f) {
      const std::uint32_t part = qtet::kFirstFieldPart + f;
      (void)refiner.applyField(f, c, std::vector<std::int32_t>(std::size_t{index.tuples(c, part)} * index.components(part), in.next()));
    }
  }
  return 0;
}
