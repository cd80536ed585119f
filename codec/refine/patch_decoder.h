// Decodes one patch: a coarse part comes in, blocks come in, the mesh becomes finer (FORMAT.md,
// "Refinement"). Numbers are the patch's own. Today's log is one patch, whose coarse part is the
// base mesh; the refiner puts fields and chunks to it.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "codec/refine/patch_records.h"

namespace qtet {

/// How much of a block has come.
enum class Extent : std::uint8_t {
  kPartial,  // it ended at stopLevel
  kWhole,
};

class PatchDecoder {
 public:
  /// `requests` must outlive it.
  PatchDecoder(const PatchKind& kind, const PatchRequests& requests)
      : requests_(requests), records_(kind, requests) {}

  /// Takes the coarse part, which is level 0. REQUIRES: called once and first; ids in range,
  /// coordinates in the lattice.
  void start(const CoarsePart& coarse);
  /// Applies the next block, a run of levels. kPartial: up to stopLevel. Errors: bad-value,
  /// truncated, limit-exceeded, io (the gate's no); the mesh is then a part of the block's.
  [[nodiscard]] Result<Extent> read(PatchBlock& block);

  [[nodiscard]] RecordReader& records() { return records_; }
  [[nodiscard]] const RecordReader& records() const { return records_; }
  [[nodiscard]] const GrowingMesh& mesh() const { return records_.mesh(); }
  /// The complete levels, 0 first; none before the base mesh.
  [[nodiscard]] std::span<const LevelCounts> levels() const { return levels_; }
  /// The last complete level.
  [[nodiscard]] std::uint32_t level() const {
    return levels_.empty() ? 0 : static_cast<std::uint32_t>(levels_.size() - 1);
  }

 private:
  struct OpenLevel {
    std::uint32_t nextSlot = 0;
    std::size_t recordsBefore = 0;
  };

  [[nodiscard]] Result<Extent> run(PatchBlock& chunk);
  Status visit(PatchBlock& chunk, RecordCoder<RangeDecoder>& coder, std::uint32_t endSlot);
  void completeLevel();

  const PatchRequests& requests_;
  RecordReader records_;
  std::vector<LevelCounts> levels_;
  std::optional<OpenLevel> open_;  // of the level after the last complete one
};

}  // namespace qtet
