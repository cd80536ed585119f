#include "codec/log/level_choice.h"

#include <cassert>

#include "codec/log/log_levels.h"
#include "proto/level_error.h"
#include "proto/manifest.h"

namespace qtet {
namespace {

template <class ErrorOf>
Result<std::uint32_t> coarsestWithin(const Manifest& manifest, double bound,
                                     const ErrorOf& errorOf) {
  if (!manifest.levels.back().error)
    return fail(ErrorCode::kNotFound,
                "the log does not have the errors of its levels; choose by size, or simplify again "
                "with `measure` levels");
  for (const ManifestLevel& level : manifest.levels)
    if (level.error && errorOf(*level.error) <= bound) return level.level;
  return manifest.levels.back().level;
}

}  // namespace

std::uint32_t levelOfTetrahedra(const Manifest& manifest, double most) {
  std::uint32_t found = 0;
  for (const ManifestLevel& level : manifest.levels)
    if (level.tetrahedra <= most) found = level.level;
  return found;
}

std::uint32_t levelOfBytes(const Manifest& manifest, const LogIndex& index, std::uint64_t most) {
  std::uint32_t found = 0;
  for (const ManifestLevel& level : manifest.levels)
    if (prefixBytes(manifest, index, level.level) <= most) found = level.level;
  return found;
}

Result<std::uint32_t> levelOfBoundaryError(const Manifest& manifest, double bound) {
  return coarsestWithin(manifest, bound,
                        [](const LevelError& error) { return error.boundaryDistance(); });
}

Result<std::uint32_t> levelOfFieldError(const Manifest& manifest, std::size_t field, double bound) {
  assert(field < manifest.fields.size());
  return coarsestWithin(manifest, bound,
                        [field](const LevelError& error) { return error.fields[field].rms; });
}

}  // namespace qtet
