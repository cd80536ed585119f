// How a refiner makes its mesh of chunks: the base mesh, the level runs of the head (all of
// `stream`), and the packets of `regions`. For refiner*.cpp and nobody else.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "codec/log/refiner_records.h"
#include "codec/mesh/node_cells.h"
#include "codec/record/child_coder.h"

namespace qtet {

/// How much of a chunk has come.
enum class Extent : std::uint8_t {
  kNothing,
  kCut,  // it ended at stopLevel
  kWhole,
};

/// Which levels are complete.
class LevelBook {
 public:
  explicit LevelBook(const ChunkPlan& plan);

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
  HeadReader(const RefinerOrders& orders, RecordReader& records, LevelBook& levels)
      : orders_(orders), records_(records), levels_(levels) {}

  /// Reads a chunk's records; kCut: up to stopLevel.
  [[nodiscard]] Result<Extent> read(ChunkInHand& chunk);

 private:
  struct OpenLevel {
    std::uint32_t nextSlot = 0;
    std::size_t recordsBefore = 0;
  };

  Status visit(ChunkInHand& chunk, RecordCoder<RangeDecoder>& coder, std::uint32_t endSlot);

  const RefinerOrders& orders_;
  RecordReader& records_;
  LevelBook& levels_;
  std::optional<OpenLevel> open_;  // of the level after the last complete one
};

/// The packets of `regions`: which cells wait for which.
class PacketReader {
 public:
  /// All must outlive it.
  PacketReader(const ChunkPlan& plan, const RefinerOrders& orders, RecordReader& records,
               LevelBook& levels);

  /// Reads the end of the head's last chunk. REQUIRES: there are packets.
  Status endHead(ChunkInHand& chunk);
  /// Reads a packet; kCut: up to stopLevel.
  [[nodiscard]] Result<Extent> read(ChunkInHand& packet);

 private:
  struct HeadModels {
    RecordModels records;
    ChildModels children;
  };

  Status level(ChunkInHand& packet, std::uint32_t level, RecordCoder<RangeDecoder>& coder,
               std::vector<VertexId>& inner);
  Status children(ChunkInHand& chunk, std::uint32_t node, const NodeCells& cells);

  const ChunkPlan& plan_;
  const RefinerOrders& orders_;
  RecordReader& records_;
  LevelBook& levels_;
  ChildModels models_;
  HeadModels head_;                 // as the head left them: what every packet starts from
  std::vector<NodeCells> waiting_;  // by node: cells of packets that may come next
  VertexCounts counts_;
};

/// The mesh of a refiner, with the readers of its three kinds of chunks.
class MeshReader {
 public:
  /// Both must outlive it.
  MeshReader(const ChunkPlan& plan, const RefinerOrders& orders)
      : plan_(plan),
        records_(plan, orders),
        levels_(plan),
        head_(orders, records_, levels_),
        packets_(plan, orders, records_, levels_) {}
  MeshReader(const MeshReader&) = delete;
  MeshReader& operator=(const MeshReader&) = delete;

  /// Applies a chunk's structure and positions, what the table says of it included.
  [[nodiscard]] Result<Extent> read(ChunkInHand& chunk);

  [[nodiscard]] RecordReader& records() { return records_; }
  [[nodiscard]] const RecordReader& records() const { return records_; }
  [[nodiscard]] const GrowingMesh& mesh() const { return records_.mesh(); }
  [[nodiscard]] const LevelBook& levels() const { return levels_; }

 private:
  Status base(ChunkInHand& chunk);

  const ChunkPlan& plan_;
  RecordReader records_;
  LevelBook levels_;
  HeadReader head_;
  PacketReader packets_;
};

}  // namespace qtet
