// The base mesh, which a log's first chunk holds (FORMAT.md, "Base mesh").
#pragma once

#include <vector>

#include "codec/mesh/coarse_part.h"
#include "codec/record/base_coder.h"
#include "codec/refine/patch_block.h"

namespace qtet {

struct BaseMesh {
  CoarsePart mesh;                ///< nothing is frozen
  std::vector<BaseBirth> births;  ///< of its vertices, for their values of fields
};

/// Errors: bad-value (the structure contradicts itself, a vertex outside the lattice).
[[nodiscard]] Result<BaseMesh> decodeBaseMesh(PatchBlock& block, int positionBits);
[[nodiscard]] std::unexpected<Error> refuseBaseMesh(const PatchBlock& block);

}  // namespace qtet
