// How a refiner makes its mesh of chunks: the base mesh, and runs of levels. For refiner*.cpp and
// nobody else.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "codec/refine/refiner_records.h"

namespace qtet {

/// How much of a chunk has come.
enum class Extent : std::uint8_t {
  kPartial,  // it ended at stopLevel
  kWhole,
};

/// The mesh of a refiner, and where in a level its chunks have come to.
class MeshReader {
 public:
  /// Both must outlive it.
  MeshReader(const ChunkPlan& plan, const RefinerSettings& settings)
      : settings_(settings), records_(plan, settings) {}

  /// Applies a chunk's structure and positions, what the table says of it included; kPartial: up
  /// to stopLevel.
  [[nodiscard]] Result<Extent> read(ChunkInput& chunk);

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

  Status base(ChunkInput& chunk);
  [[nodiscard]] Result<Extent> run(ChunkInput& chunk);
  Status visit(ChunkInput& chunk, RecordCoder<RangeDecoder>& coder, std::uint32_t endSlot);
  void completeLevel();

  const RefinerSettings& settings_;
  RecordReader records_;
  std::vector<LevelCounts> levels_;
  std::optional<OpenLevel> open_;  // of the level after the last complete one
};

}  // namespace qtet
