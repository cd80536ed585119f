// How a refiner makes its mesh of chunks: the base mesh, the level runs of the head (all of
// `stream`), and the packets of `regions`. For refiner*.cpp and nobody else.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "codec/mesh/node_cells.h"
#include "codec/record/child_coder.h"
#include "codec/refine/refiner_records.h"

namespace qtet {

/// How much of a chunk has come.
enum class Extent : std::uint8_t {
  kNothing,
  kPartial,  // it ended at stopLevel
  kWhole,
};

/// Which levels are complete.
class LevelProgress {
 public:
  explicit LevelProgress(const ChunkPlan& plan);

  /// Level 0 first; none before the base mesh.
  [[nodiscard]] std::span<const LevelCounts> complete() const { return complete_; }
  /// The last complete level.
  [[nodiscard]] std::uint32_t last() const {
    return complete_.empty() ? 0 : static_cast<std::uint32_t>(complete_.size() - 1);
  }
  /// The next level of the head is complete.
  void complete(const Slots& mesh) {
    complete_.push_back({mesh.vertices, mesh.tetrahedra, mesh.triangles});
  }
  /// A packet brought the slots between these in `level`.
  void bring(std::uint32_t level, const Slots& before, const Slots& after);
  /// A packet of these levels has come: they are complete once every packet of their band has.
  /// False: one of them is without a record.
  [[nodiscard]] bool endPacket(std::uint32_t firstLevel, std::uint32_t lastLevel);

 private:
  std::vector<LevelCounts> complete_;
  // by level of a band: what its packets have brought so far, and packets that have not come
  std::vector<LevelCounts> added_;
  std::vector<std::uint32_t> missing_;
};

/// The level runs of the head: where in a level its chunks have come to.
class HeadReader {
 public:
  /// All must outlive it.
  HeadReader(const RefinerSettings& settings, RecordReader& records, LevelProgress& levels)
      : settings_(settings), records_(records), levels_(levels) {}

  /// Reads a chunk's records; kPartial: up to stopLevel.
  [[nodiscard]] Result<Extent> read(ChunkInput& chunk);

 private:
  struct OpenLevel {
    std::uint32_t nextSlot = 0;
    std::size_t recordsBefore = 0;
  };

  Status visit(ChunkInput& chunk, RecordCoder<RangeDecoder>& coder, std::uint32_t endSlot);

  const RefinerSettings& settings_;
  RecordReader& records_;
  LevelProgress& levels_;
  std::optional<OpenLevel> open_;  // of the level after the last complete one
};

/// The packets of `regions`: which cells wait for which.
class PacketReader {
 public:
  /// All must outlive it.
  PacketReader(const ChunkPlan& plan, const RefinerSettings& settings, RecordReader& records,
               LevelProgress& levels);

  /// Reads the end of the head's last chunk. REQUIRES: there are packets.
  Status endHead(ChunkInput& chunk);
  /// Reads a packet; kPartial: up to stopLevel.
  [[nodiscard]] Result<Extent> read(ChunkInput& packet);

 private:
  struct HeadModels {
    RecordModels records;
    ChildModels children;
  };

  Status level(ChunkInput& packet, std::uint32_t level, RecordCoder<RangeDecoder>& coder,
               std::vector<VertexId>& inner);
  Status children(ChunkInput& chunk, std::uint32_t node, const NodeCells& cells);

  const ChunkPlan& plan_;
  const RefinerSettings& settings_;
  RecordReader& records_;
  LevelProgress& levels_;
  ChildModels models_;
  HeadModels head_;                 // as the head left them: what every packet starts from
  std::vector<NodeCells> waiting_;  // by node: cells of packets that may come next
  VertexCounts counts_;
};

/// The mesh of a refiner, with the readers of its three kinds of chunks.
class MeshReader {
 public:
  /// Both must outlive it.
  MeshReader(const ChunkPlan& plan, const RefinerSettings& settings)
      : plan_(plan),
        records_(plan, settings),
        levels_(plan),
        head_(settings, records_, levels_),
        packets_(plan, settings, records_, levels_) {}
  MeshReader(const MeshReader&) = delete;
  MeshReader& operator=(const MeshReader&) = delete;

  /// Applies a chunk's structure and positions, what the table says of it included.
  [[nodiscard]] Result<Extent> read(ChunkInput& chunk);

  [[nodiscard]] RecordReader& records() { return records_; }
  [[nodiscard]] const RecordReader& records() const { return records_; }
  [[nodiscard]] const GrowingMesh& mesh() const { return records_.mesh(); }
  [[nodiscard]] const LevelProgress& levels() const { return levels_; }

 private:
  Status base(ChunkInput& chunk);

  const ChunkPlan& plan_;
  RecordReader records_;
  LevelProgress levels_;
  HeadReader head_;
  PacketReader packets_;
};

}  // namespace qtet
