#include "codec/level_refiner.h"

#include <algorithm>

namespace qtet {

Status LevelRefiner::apply(std::uint32_t chunk, ByteView structure, std::span<const std::int32_t> positions) {
  if (Status s = refiner_.apply(chunk, structure, positions); !s) return s;
  kept_.push_back({kPositionsPart, chunk, Bytes(structure.begin(), structure.end()), {positions.begin(), positions.end()}});
  return {};
}

Status LevelRefiner::applyField(std::uint32_t field, std::uint32_t chunk, std::span<const std::int32_t> values) {
  if (Status s = refiner_.applyField(field, chunk, values); !s) return s;
  kept_.push_back({kFirstFieldPart + field, chunk, {}, {values.begin(), values.end()}});
  return {};
}

Status LevelRefiner::give(Refiner& refiner, const Kept& kept) {
  return kept.part == kPositionsPart ? refiner.apply(kept.chunk, kept.structure, kept.values)
                                     : refiner.applyField(kept.part - kFirstFieldPart, kept.chunk, kept.values);
}

Status LevelRefiner::goTo(std::uint32_t level) {
  refiner_ = Refiner(LogIndex(refiner_.index()));  // first of all: there may be no memory for two meshes
  refiner_.stopAtLevel(level);
  for (const Kept& kept : kept_)  // what lies beyond the level is out of order, and so is what depends on it
    if (Status s = give(refiner_, kept); !s && s.error().code != ErrorCode::kBadOrder) return s;
  return {};
}

void LevelRefiner::forgetBeyond() {
  std::erase_if(kept_, [&](const Kept& kept) {
    return kept.part == kPositionsPart ? !refiner_.applied(kept.chunk) : !refiner_.fieldApplied(kept.part - kFirstFieldPart, kept.chunk);
  });
}

std::size_t LevelRefiner::keptBytes() const {
  std::size_t bytes = 0;
  for (const Kept& kept : kept_) bytes += kept.structure.size() + kept.values.size() * sizeof(std::int32_t);
  return bytes;
}

}  // namespace qtet
