#include "codec/refine/level_fields.h"

#include <algorithm>
#include <cassert>
#include <utility>

#include "codec/log/last_uses.h"
#include "codec/refine/refiner.h"

namespace qtet {

LevelFields::LevelFields(const LogFile& log, Refiner& refiner, std::vector<std::uint32_t> wanted,
                         std::stop_token stop)
    : log_(log),
      refiner_(refiner),
      stop_(std::move(stop)),
      needed_(withParents(log.fields(), std::move(wanted))),
      uses_(lastUses(log.fields(), needed_)) {}

LevelFields::~LevelFields() { forgetAll(); }

void LevelFields::forgetAll() {
  for (const std::uint32_t field : needed_) refiner_.forgetField(field);
  next_ = 0;
}

Status LevelFields::decode(std::uint32_t field) {
  for (std::uint32_t chunk = refiner_.fieldChunksApplied(field); chunk < refiner_.chunksApplied();
       ++chunk) {
    if (stop_.stop_requested())
      return fail(ErrorCode::kIo, "stopped, because nobody waits for the level any more");
    if (Status s = applyFieldBlock(log_, refiner_, chunk, field); !s) return s;
  }
  return {};
}

std::span<const std::int32_t> LevelFields::integers(std::uint32_t field) {
  const auto place = std::ranges::lower_bound(needed_, field);
  assert(place != needed_.end() && *place == field);
  const auto end = static_cast<std::size_t>(place - needed_.begin());
  if (end + 1 == next_) return refiner_.fieldValues(field);  // once more
  if (end < next_) forgetAll();
  for (; status_ && next_ <= end; ++next_) {
    if (next_ > 0)
      for (const std::uint32_t ended : uses_[next_ - 1]) refiner_.forgetField(ended);
    status_ = decode(needed_[next_]);
  }
  return status_ ? refiner_.fieldValues(field) : std::span<const std::int32_t>();
}

}  // namespace qtet
