// A refiner's state: its mesh, its fields, and which chunks have arrived. For refiner.cpp only.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "codec/record/base_coder.h"
#include "codec/refine/chunk_plan.h"
#include "codec/refine/patch_decoder.h"
#include "codec/refine/refiner.h"
#include "codec/refine/refiner_fields.h"

namespace qtet {

struct Refiner::State {
  enum class Phase : std::uint8_t {
    kOpen,
    kStopped,  // inside a chunk, at stopLevel
    kBroken,   // a chunk failed, or is being applied
  };

  explicit State(const LogIndex& logIndex)
      : plan(logIndex),
        mesh(kindOf(plan.index), requests),
        fields(plan, mesh.records(), baseBirths, added) {}

  static PatchKind kindOf(const LogIndex& index);

  [[nodiscard]] Status mayCome(std::uint32_t chunk) const;
  Status apply(std::uint32_t chunk, ByteView structure, Values& positions);
  void makeRoom(std::size_t bytes);

  [[nodiscard]] Result<Extent> readBase(PatchBlock& block);
  [[nodiscard]] Result<Extent> readRun(PatchBlock& block);

  ChunkPlan plan;
  PatchRequests requests;
  PatchDecoder mesh;
  std::vector<BaseBirth> baseBirths;
  std::vector<AddedElements> added;  // by chunk that has come
  Phase phase = Phase::kOpen;
  RefinerFields fields;
  // bytes of structure that have come; none once memory for the whole log was asked for
  std::optional<std::uint64_t> structureBytes = 0;
};

}  // namespace qtet
