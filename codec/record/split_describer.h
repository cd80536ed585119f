// Describes each split of the way back, as the history has it, in the record coder's terms.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "codec/mesh/link.h"
#include "codec/record/fusion_history.h"
#include "codec/record/mirror_mesh.h"
#include "codec/record/record_coder.h"

namespace qtet {

class SplitDescriber {
 public:
  /// Both must outlive it.
  SplitDescriber(const FusionHistory& history, const MirrorMesh& mirror);

  /// The fusion that a split of v undoes in the current level, or nullptr.
  [[nodiscard]] const Fusion* fusionAt(VertexId v) const;
  /// Describes the split of v that undoes `fusion`, and numbers its prey as the record does: in
  /// order of first appearance along the link. False: the history's cells are not those of v's
  /// star. REQUIRES: `link` is v's and a sphere.
  [[nodiscard]] bool describe(VertexId v, const Link& link, Fusion& fusion, RecordTruth& truth);
  /// The history's cells that the split described last brings back, in that order.
  [[nodiscard]] const std::vector<std::uint32_t>& restored(const Split& split);

 private:
  bool labels(VertexId v, const Fusion& fusion, RecordTruth& truth);
  bool deleted(const Link& link, const Fusion& fusion, RecordTruth& truth);

  const FusionHistory& history_;
  const MirrorMesh& mirror_;
  std::vector<std::uint32_t> fusionOf_;  // by vertex of the history: the fusion that made it
  std::vector<std::uint8_t> labelOf_;    // by cell of the history; kNoLabel between two uses
  // of the current split, sorted: the record's cell, the history's cell
  std::vector<std::pair<LocalCell, std::uint32_t>> deleted_;
  std::vector<std::uint32_t> restored_;
};

}  // namespace qtet
