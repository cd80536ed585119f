#include "codec/refine/base_mesh.h"

#include <utility>

#include "codec/mesh/boundary.h"

namespace qtet {

std::unexpected<Error> refuseBaseMesh(const PatchBlock& block) {
  return block.refuse(ErrorCode::kBadValue, "the base mesh's structure contradicts itself");
}

Result<BaseMesh> decodeBaseMesh(PatchBlock& block, int positionBits) {
  const ChunkEntry& entry = block.entry;
  BaseCoder<RangeDecoder> coder(block.decoder, entry.newVertices, entry.newTetrahedra);
  if (!coder.run(nullptr, [&] { return block.decoder.overrun(); })) return refuseBaseMesh(block);
  BaseMesh out;
  out.births = std::move(coder.births);
  const std::int32_t size = std::int32_t{1} << positionBits;
  std::vector<LatticePoint>& points = out.mesh.points;
  points.reserve(entry.newVertices);
  const auto at = [&](VertexId u, std::uint32_t c) { return points[u][c]; };
  for (std::uint32_t v = 0; v < entry.newVertices; ++v) {
    LatticePoint p{};
    for (std::uint32_t c = 0; c < 3; ++c) {
      p[c] = block.positions.code<false>(predictBase(out.births[v], v, c, true, at), 0);
      if (block.positions.bad() || p[c] < 0 || p[c] >= size)
        return block.refuse(ErrorCode::kBadValue, "a vertex lies outside the lattice");
    }
    points.push_back(p);
  }
  out.mesh.tetrahedra = std::move(coder.tetrahedra);
  out.mesh.boundary = boundaryOf(out.mesh.tetrahedra);
  return out;
}

}  // namespace qtet
