// A refiner that also goes back to coarser levels: for a slider that moves down, or a phone that runs out of memory.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "codec/refiner.h"

namespace qtet {

/// Keeps the blocks that it was given (2 to 3 bytes a tetrahedron, and a field's integers), so that it needs nobody to make any level of the part of
/// the log that has come. Going to a level decodes it anew: exact by construction, and no dearer than decoding that level the first time.
class LevelRefiner {
 public:
  explicit LevelRefiner(LogIndex index) : refiner_(std::move(index)) {}

  /// Refiner::apply and Refiner::applyField; what they refuse is not kept. Also bad-order: a chunk beyond the level that goTo() asked for.
  Status apply(std::uint32_t chunk, ByteView structure, std::span<const std::int32_t> positions);
  Status applyField(std::uint32_t field, std::uint32_t chunk, std::span<const std::int32_t> values);

  /// Makes the mesh that of `level`, or the finest that has come if that is coarser; a level of kMaxLevels is everything. The mesh and its fields are
  /// then what a refiner with stopAtLevel(level) would hold. No error that these blocks did not give when they came.
  Status goTo(std::uint32_t level);
  /// Forgets the blocks beyond the present level: chunks that have to be fetched again. Memory follows when the mesh was made smaller by goTo().
  void forgetBeyond();

  [[nodiscard]] const Refiner& refiner() const { return refiner_; }
  /// Bytes of the blocks kept.
  [[nodiscard]] std::size_t keptBytes() const;

 private:
  struct Kept {
    std::uint32_t part = 0;  // kPositionsPart, which stands for the structure, too, or a field's
    std::uint32_t chunk = 0;
    Bytes structure;
    std::vector<std::int32_t> values;
  };
  static Status give(Refiner& refiner, const Kept& kept);

  Refiner refiner_;
  std::vector<Kept> kept_;  // in the order of arrival, so each after what it depends on
};

}  // namespace qtet
