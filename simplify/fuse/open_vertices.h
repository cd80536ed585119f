// The vertices that may still be fused, with their candidates kept up to date.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "simplify/fuse/fusion_proposer.h"
#include "simplify/fuse/fusion_state.h"
#include "simplify/fuse/level_fusions.h"
#include "simplify/fuse/queue_entries.h"
#include "simplify/mesh/workers.h"

namespace qtet {

class OpenVertices {
 public:
  /// REQUIRES: all outlive this; a proposer a worker whenever candidates are looked for.
  OpenVertices(FusionState& state, Workers& workers, const Proposers& proposers)
      : state_(state), workers_(workers), proposers_(proposers) {}

  /// Looks for all candidates again.
  void findAll();
  /// Takes in the vertices that a level fused, with their candidates. REQUIRES: carried out.
  void add(const LevelFusions& level);

  /// The vertices that have a candidate of finite cost, in order of the vertices. Vertices without
  /// candidates now and later are left out for good.
  void fill(std::vector<QueueEntry>& entries);

 private:
  template <class Find>
  void collect(std::span<const VertexId> vertices, const Find& find);
  void prefetchFused(const LevelFusions& level, std::size_t i) const;

  FusionState& state_;
  Workers& workers_;
  const Proposers& proposers_;
  std::vector<VertexId> vertices_;             // ascending
  std::vector<std::vector<Candidate>> found_;  // collect's own
};

}  // namespace qtet
