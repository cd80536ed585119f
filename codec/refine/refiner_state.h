// A refiner's state: its mesh, its fields, and which chunks have arrived. For refiner.cpp only.
#pragma once

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "codec/log/log_index.h"
#include "codec/refine/refiner.h"
#include "codec/refine/refiner_chunks.h"
#include "codec/refine/refiner_fields.h"

namespace qtet {

struct Refiner::State {
  enum class Phase : std::uint8_t {
    kOpen,
    kStopped,  // inside a chunk, at stopLevel
    kBroken,   // a chunk failed, or is being applied
  };

  explicit State(LogIndex logIndex)
      : plan(std::move(logIndex)), mesh(plan, settings), fields(plan, mesh.records(), added) {}

  [[nodiscard]] Status mayCome(std::uint32_t chunk) const;
  Status apply(std::uint32_t chunk, ByteView structure, Values& positions);
  void makeRoom(std::size_t bytes);

  ChunkPlan plan;
  RefinerSettings settings;
  MeshReader mesh;
  std::vector<AddedElements> added;  // by chunk that has come
  Phase phase = Phase::kOpen;
  RefinerFields fields;
  // bytes of structure that have come; none once memory for the whole log was asked for
  std::optional<std::uint64_t> structureBytes = 0;
};

}  // namespace qtet
