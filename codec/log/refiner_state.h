// What a refiner keeps: shared by refiner*.cpp and by nobody else.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "codec/log/refiner.h"
#include "codec/mesh/growing_mesh.h"
#include "codec/mesh/node_cells.h"
#include "codec/record/base_coder.h"
#include "codec/record/cell_values.h"
#include "codec/record/child_coder.h"
#include "codec/record/point_values.h"
#include "codec/record/record_coder.h"
#include "codec/record/values.h"
#include "proto/limits.h"

namespace qtet {

[[nodiscard]] std::unexpected<Error> refuseChunk(ErrorCode code, std::uint32_t chunk,
                                                 const std::string& what);

struct Refiner::State {
  explicit State(LogIndex logIndex);

  struct Field {
    std::vector<std::int32_t> values;
    std::vector<bool> applied;  // by chunk
    std::uint32_t chunks = 0;
    bool broken = false;  // a block failed half-way: what it wrote is noise
  };
  /// What a chunk has brought.
  struct Brought {
    bool applied = false;
    bool cut = false;  // ended at stopLevel
    std::size_t firstBirth = 0, endBirth = 0;
    Slots end;  // of the slots that it filled
  };
  struct Models {
    RecordModels records;
    ChildModels children;
  };

  LogIndex index;
  std::uint32_t headChunks = 0, firstDepth = 0, lastDepth = 0;
  std::vector<Slots> slots;  // of each chunk the first, and the end
  std::vector<Brought> brought;

  GrowingMesh mesh;
  Link link;
  Split inHand;
  Models models;
  Models headModels;               // as the head left them: what every packet starts from
  std::vector<NodeCells> waiting;  // by node: cells of packets that may come next
  VertexCounts counts;
  std::vector<BaseBirth> baseBirths;
  PointAncestry births;
  bool hasCellField = false;
  CellAncestry ancestry;  // kept where there is a cell field
  std::vector<Field> fields;

  std::vector<LevelCounts> levelCounts;  // of the complete levels
  std::vector<LevelCounts> added;        // by level of a band: what its packets have brought so far
  std::vector<std::uint32_t> missing;    // by level of a band: packets that have not come
  std::uint32_t chunks = 0;
  std::uint64_t structureBytes = 0;  // that have come
  bool roomy = false;                // memory for the whole log was asked for
  std::uint32_t level = 0;           // of the head, being refined, or the last complete one
  std::uint32_t nextSlot = 0;        // of the level being refined
  bool inLevel = false;
  std::size_t levelBirths = 0;  // births before the level
  bool broken = false;
  bool stopped = false;  // inside a chunk of the head, at stopLevel
  std::uint32_t stopLevel = kMaxLevels + 1;
  SplitObserver* observer = nullptr;
  LevelGate* gate = nullptr;

  void makeRoom(std::size_t bytes);
  [[nodiscard]] Status mayCome(std::uint32_t chunk) const;
  [[nodiscard]] bool isPacket(std::uint32_t chunk) const { return chunk >= headChunks; }
  [[nodiscard]] std::uint32_t dependencyOf(std::uint32_t chunk) const {
    return index.dependencies[index.chunks[chunk].firstDependency];
  }
  [[nodiscard]] std::uint32_t lastLevel() const {
    return levelCounts.empty() ? 0 : static_cast<std::uint32_t>(levelCounts.size() - 1);
  }

  // refiner_chunks.cpp
  Status base(const ChunkEntry& entry, ByteView structure, Values& positions);
  Status records(std::uint32_t chunk, const ChunkEntry& entry, ByteView structure,
                 Values& positions);
  Status run(std::uint32_t chunk, const ChunkEntry& entry, RangeDecoder& decoder,
             Values& positions);
  Status packet(std::uint32_t chunk, const ChunkEntry& entry, ByteView structure,
                Values& positions);
  Status packetLevel(std::uint32_t chunk, std::uint32_t atLevel, RecordCoder<RangeDecoder>& coder,
                     RangeDecoder& decoder, std::vector<VertexId>& inner);
  Status endHead(std::uint32_t chunk, RangeDecoder& decoder);
  Status children(std::uint32_t chunk, std::uint32_t node, const NodeCells& cells,
                  RangeDecoder& decoder);
  Status endPacket(std::uint32_t chunk, const ChunkEntry& entry);
  Status split(std::uint32_t chunk, RecordCoder<RangeDecoder>& coder, VertexId v);
  Status checkCounts(std::uint32_t chunk) const;
  [[nodiscard]] Status mayGoOn() const {
    return gate == nullptr || gate->goOn() ? Status{}
                                           : fail(ErrorCode::kIo, "stopped, as was asked for");
  }
  void completeLevel() {
    levelCounts.push_back({mesh.points.size(), mesh.tetrahedra.size(), mesh.boundary.size()});
  }

  // refiner_fields.cpp
  void inherit(Field& field, const FieldShape& shape, std::uint32_t chunk) const;
  void inheritPoints(Field& field, std::uint32_t components, std::size_t firstBirth) const;
  void inheritCells(Field& field, const FieldShape& shape, CellId first, CellId end) const;
  void codePoints(Field& field, const FieldShape& shape, std::uint32_t chunk,
                  Values& residuals) const;
  void codeCells(Field& field, const FieldShape& shape, std::uint32_t chunk,
                 Values& residuals) const;
};

}  // namespace qtet
