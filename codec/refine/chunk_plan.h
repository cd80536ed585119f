// The chunk table of a log, and what follows from it. For refiner*.cpp and nobody else.
#pragma once

#include <cstdint>
#include <vector>

#include "codec/log/log_index.h"
#include "codec/mesh/mesh.h"

namespace qtet {

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
