// Describes each split of the way back, as the history has it, in the record coder's terms.
#pragma once

#include <array>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <span>
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

  /// A slot of the mirror, the next one or an earlier one, has another vertex of the history.
  void place(VertexId slot);
  /// The fusion that a split of v undoes in the current level, or nullptr. REQUIRES: place(v).
  [[nodiscard]] const Fusion* fusionAt(VertexId v) const {
    assert(v < next_.size());
    return next_[v].level == mirror_.mesh().level() ? &history_.fusions[next_[v].fusion] : nullptr;
  }
  /// A hint: the current level's splits are described in the order of their slots, that of v next.
  void lookAhead(VertexId v);
  /// Describes the split of v that undoes `fusion`, and numbers its prey as the record does: in
  /// order of first appearance along the link. False: the history's cells are not those of v's
  /// star. REQUIRES: `link` is v's and a sphere.
  [[nodiscard]] bool describe(VertexId v, const Link& link, Fusion& fusion, RecordTruth& truth);
  /// The history's cells that the split described last brings back, in that order.
  [[nodiscard]] const std::vector<std::uint32_t>& restored(const Split& split);

 private:
  /// The split that a vertex waits for: a fusion, and the log's level, 0 where there is none.
  struct Next {
    std::uint32_t fusion = 0, level = 0;
  };
  /// The splits that come next.
  class Ahead {
   public:
    static constexpr std::size_t kMax = 8;
    [[nodiscard]] std::size_t size() const { return size_; }
    [[nodiscard]] VertexId operator[](std::size_t i) const { return slots_[(first_ + i) % kMax]; }
    void push(VertexId slot) {
      assert(size_ < kMax);
      slots_[(first_ + size_++) % kMax] = slot;
    }
    void pop() {
      assert(size_ > 0);
      first_ = (first_ + 1) % kMax, --size_;
    }

   private:
    std::array<VertexId, kMax> slots_{};
    std::size_t first_ = 0, size_ = 0;
  };

  void expectLists(VertexId v) const;
  void expectCells(VertexId v) const;
  void expectCorners(VertexId v) const;
  [[nodiscard]] std::span<const std::uint32_t> affectedBy(const Fusion& fusion) const {
    return std::span(history_.affectedCells).subspan(fusion.firstAffected, fusion.affectedCount);
  }
  [[nodiscard]] std::span<const std::uint32_t> deletedBy(const Fusion& fusion) const {
    return std::span(history_.deletedCells).subspan(fusion.firstDeleted, fusion.deletedCount);
  }
  bool labels(VertexId v, const Fusion& fusion, RecordTruth& truth);
  bool deleted(const Link& link, const Fusion& fusion, RecordTruth& truth);

  const FusionHistory& history_;
  const MirrorMesh& mirror_;
  std::vector<Next> waiting_;  // by vertex of the history
  std::vector<Next> next_;     // the same by slot
  Ahead ahead_;
  VertexId seen_ = 0;                  // slots that ahead_ has been asked about, in
  std::uint32_t seenLevel_ = 0;        // this level
  std::vector<std::uint8_t> labelOf_;  // by cell of the history; kNoLabel between two uses
  // of the current split, sorted: the record's cell, the history's cell
  std::vector<std::pair<LocalCell, std::uint32_t>> deleted_;
  std::vector<std::uint32_t> restored_;
};

}  // namespace qtet
