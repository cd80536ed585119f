// One block of a patch while it is read: structure and positions.
#pragma once

#include <cstdint>
#include <string>

#include "codec/coding/range_coder.h"
#include "codec/log/chunk_entry.h"
#include "codec/mesh/mesh.h"
#include "codec/record/values.h"
#include "proto/error.h"

namespace qtet {

[[nodiscard]] std::unexpected<Error> refuseChunk(ErrorCode code, std::uint32_t chunk,
                                                 const std::string& what);

struct PatchBlock {
  std::uint32_t number;     // of its chunk, for messages
  const ChunkEntry& entry;  // its row of the table
  RangeDecoder decoder;     // of the structure
  Values& positions;
  Slots end;            // of the slots that it may fill
  std::size_t records;  // how many there may be at its end, of all of the patch's blocks

  [[nodiscard]] std::unexpected<Error> refuse(ErrorCode code, const std::string& what) const {
    return refuseChunk(code, number, what);
  }
};

}  // namespace qtet
