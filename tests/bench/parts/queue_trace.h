// The operations that a simplifier asks of its priority queue: recorded from a model of the
// simplifier on a grid of vertices, without a mesh.
//
// As in simplify/, each vertex has one entry, its cheapest candidate, and the least is popped. A
// candidate that is gone or illegal gives way to the vertex's next, dearer one. One whose vertices
// are locked waits for the level's end. A fusion kills its vertices and enters the fused one,
// dearer, at the level's end. A level ends at the 35 % quantile of the keys at its start. On the
// meshes comb and bluntfin the simplifier made 6 to 10 pops a vertex. Among these, 7-12 % of the
// vertices were dead and 30 % of the candidates gone. 46-53 % were locked, 1-3 % illegal, 7-11 %
// fused. The model is within these figures or close to them.
#pragma once

#include <cstdint>
#include <vector>

namespace qtet::bench {

struct QueueEntry {
  float key = 0;  ///< positive; less is popped first
  std::uint32_t owner = 0;

  /// Equal keys in the order of their owners, so that every exact queue pops the same.
  [[nodiscard]] bool isBefore(const QueueEntry& other) const {
    return key != other.key ? key < other.key : owner < other.owner;
  }
};

struct QueueTrace {
  static constexpr float kPop = -1;

  /// Entries to push, and kPop as the key for a pop; never a pop of an empty queue.
  std::vector<QueueEntry> operations;
  std::uint64_t pops = 0, dead = 0, gone = 0, locked = 0, illegal = 0, fused = 0, levels = 0;
  std::uint64_t checksum = 0;  ///< of the owners popped, in order
};

[[nodiscard]] inline std::uint64_t withPopped(std::uint64_t checksum, std::uint32_t owner) {
  return checksum * 0x9E3779B97F4A7C15u + owner;
}

/// Records the trace of a mesh of `vertices` vertices, simplified to one in a hundred.
[[nodiscard]] QueueTrace recordQueueTrace(std::uint32_t vertices);

}  // namespace qtet::bench
