#include "codec/log/target_choice.h"

#include <algorithm>
#include <cassert>
#include <variant>

#include "codec/log/log_index.h"
#include "codec/log/log_levels.h"
#include "proto/level_error.h"
#include "proto/manifest.h"

namespace qtet {
namespace {

/// The coarsest level whose error is known and at most `bound`, or the last one.
template <class ErrorOf>
Result<std::uint32_t> coarsestOf(const Manifest& manifest, double bound, const ErrorOf& errorOf) {
  if (!manifest.levels.back().error)
    return fail(ErrorCode::kNotFound,
                "the log does not have the errors of its levels; choose by size, or simplify "
                "again with `measure` levels");
  const auto found = std::ranges::find_if(manifest.levels, [&](const ManifestLevel& level) {
    return level.error && errorOf(*level.error) <= bound;
  });
  return found == manifest.levels.end() ? manifest.levels.back().level : found->level;
}

class LevelChooser {
 public:
  LevelChooser(const Manifest& manifest, const LogIndex& index)
      : manifest_(manifest), index_(index) {}

  Result<std::uint32_t> operator()(const EverythingTarget&) const { return last(); }
  Result<std::uint32_t> operator()(const LevelTarget& t) const { return std::min(t.level, last()); }
  Result<std::uint32_t> operator()(const BytesTarget& t) const {
    return finest([&](const ManifestLevel& level) {
      return prefixBytes(manifest_, index_, level.level) <= t.bytes;
    });
  }
  Result<std::uint32_t> operator()(const TetrahedraTarget& t) const {
    return finest([&](const ManifestLevel& level) { return level.tetrahedra <= t.tetrahedra; });
  }
  Result<std::uint32_t> operator()(const FieldErrorTarget& t) const {
    const auto field = fieldOfKey(manifest_, t.field);
    if (!field) return std::unexpected(noSuchField(manifest_, t.field));
    return coarsestOf(manifest_, t.error,
                      [&](const LevelError& error) { return error.fields[*field].rms; });
  }
  Result<std::uint32_t> operator()(const BoundaryErrorTarget& t) const {
    return coarsestOf(manifest_, t.error,
                      [](const LevelError& error) { return error.boundaryDistance(); });
  }

 private:
  [[nodiscard]] std::uint32_t last() const { return manifest_.levels.back().level; }

  template <class Fits>
  [[nodiscard]] std::uint32_t finest(const Fits& fits) const {
    const auto found =
        std::ranges::find_if(manifest_.levels.rbegin(), manifest_.levels.rend(), fits);
    return found == manifest_.levels.rend() ? 0 : found->level;
  }

  const Manifest& manifest_;
  const LogIndex& index_;
};

std::uint32_t lastChunkWithin(const LogIndex& index, std::uint64_t bytes) {
  std::uint32_t last = 0;
  while (last + 1 < index.chunks.size() &&
         index.chunks[last + 1].offset + index.chunks[last + 1].size() <= bytes)
    ++last;
  return last;
}

}  // namespace

Result<std::uint32_t> levelFor(const Target& target, const Manifest& manifest,
                               const LogIndex& index) {
  assert(!manifest.levels.empty());
  return std::visit(LevelChooser(manifest, index), target);
}

Result<std::uint32_t> levelOfFieldErrors(double error, std::span<const std::uint32_t> fields,
                                         const Manifest& manifest) {
  assert(!manifest.levels.empty());
  return coarsestOf(manifest, error, [&](const LevelError& known) {
    double worst = 0;
    for (const std::uint32_t f : fields) {
      assert(f < known.fields.size());
      worst = std::max(worst, known.fields[f].rms);
    }
    return worst;
  });
}

Result<std::uint32_t> lastChunkFor(const Target& target, const Manifest& manifest,
                                   const LogIndex& index) {
  assert(manifest.fields.size() == index.fields.size());
  assert(!manifest.levels.empty() && manifest.levels.back().chunk < index.chunks.size());
  if (const auto* bytes = std::get_if<BytesTarget>(&target))
    return lastChunkWithin(index, bytes->bytes);
  if (const auto* error = std::get_if<FieldErrorTarget>(&target);
      error && !fieldOfKey(manifest, error->field))
    return std::unexpected(noSuchField(manifest, error->field));
  return manifest.levels[levelFor(target, manifest, index).value_or(manifest.levels.back().level)]
      .chunk;
}

}  // namespace qtet
