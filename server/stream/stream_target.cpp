#include "server/stream/stream_target.h"

#include <algorithm>
#include <cassert>

#include "codec/log/level_choice.h"
#include "codec/log/log_index.h"
#include "proto/manifest.h"

namespace qtet {
namespace {

class Chooser {
 public:
  Chooser(const LogIndex& index, const Manifest& manifest, std::uint32_t field)
      : index_(index), manifest_(manifest), field_(field) {}

  StopAt operator()(const EverythingTarget&) const { return {}; }
  StopAt operator()(const LevelTarget& t) const { return levelEnd(t.level); }
  StopAt operator()(const FieldErrorTarget& t) const {
    return known(levelOfFieldError(manifest_, field_, t.error));
  }
  StopAt operator()(const BoundaryErrorTarget& t) const {
    return known(levelOfBoundaryError(manifest_, t.error));
  }
  StopAt operator()(const TetrahedraTarget& t) const {
    if (index_.layout == Layout::kRegions) return {.tetrahedra = t.tetrahedra};
    return levelEnd(levelOfTetrahedra(manifest_, static_cast<double>(t.tetrahedra)));
  }
  StopAt operator()(const BytesTarget& t) const {
    if (index_.layout == Layout::kRegions) return {.payload = t.bytes};
    std::uint32_t last = 0;
    while (last + 1 < index_.chunks.size() &&
           index_.chunks[last + 1].offset + index_.chunks[last + 1].size() <= t.bytes)
      ++last;
    return {.lastChunk = last};
  }

 private:
  [[nodiscard]] StopAt levelEnd(std::uint32_t level) const {
    const auto last = static_cast<std::uint32_t>(manifest_.levels.size() - 1);
    return {.lastChunk = manifest_.levels[std::min(level, last)].chunk, .ofWantedOnly = true};
  }
  [[nodiscard]] StopAt known(const Result<std::uint32_t>& level) const {
    return levelEnd(level.value_or(~std::uint32_t{0}));
  }

  const LogIndex& index_;
  const Manifest& manifest_;
  std::uint32_t field_;
};

}  // namespace

StopAt stopAt(const LogIndex& index, const Manifest& manifest, const Target& target,
              std::uint32_t field) {
  assert(manifest.fields.size() == index.fields.size());
  assert(!manifest.levels.empty() && manifest.levels.back().chunk < index.chunks.size());
  assert(!std::holds_alternative<FieldErrorTarget>(target) || field < manifest.fields.size());
  return std::visit(Chooser(index, manifest, field), target);
}

}  // namespace qtet
