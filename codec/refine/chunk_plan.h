// The chunk table of a log, and what follows from it. For refiner*.cpp and nobody else.
#pragma once

#include <cstdint>
#include <vector>

#include "codec/log/log_index.h"
#include "codec/mesh/mesh.h"

namespace qtet {

/// A page decodes the base mesh by a module without the rest, which is half as large (web-client).
#ifdef QTET_BASE_ONLY
inline constexpr bool kBaseOnly = true;
#else
inline constexpr bool kBaseOnly = false;
#endif

struct ChunkPlan {
  explicit ChunkPlan(const LogIndex& logIndex) : index(logIndex), slots(1) {
    for (const ChunkEntry& e : index.chunks) {
      const Slots& s = slots.back();
      slots.push_back({s.vertices + e.newVertices, s.tetrahedra + e.newTetrahedra,
                       s.triangles + e.newBoundaryTriangles});
      records += e.records;
    }
  }

  LogIndex index;
  std::vector<Slots> slots;  // of each chunk the first, and the end
  std::uint64_t records = 0;
};

}  // namespace qtet
