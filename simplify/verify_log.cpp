#include "simplify/verify_log.h"

#include <algorithm>
#include <numeric>
#include <string>

namespace qtet {
namespace {

std::string countsText(std::size_t tetrahedra, std::size_t vertices, std::size_t boundary) {
  return std::to_string(tetrahedra) + " tetrahedra, " + std::to_string(vertices) + " vertices and " + std::to_string(boundary) +
         " boundary triangles";
}

/// What the manifest states of every level, against what the refiner met on its way.
Status checkLevels(const std::vector<ManifestLevel>& levels, std::span<const LevelCounts> met) {
  if (levels.size() != met.size())
    return fail(ErrorCode::kBadValue, "the log holds " + std::to_string(met.size()) + " levels, the manifest lists " +
                                          std::to_string(levels.size()) + "; build the log again");
  for (std::size_t i = 0; i < levels.size(); ++i) {
    const ManifestLevel& level = levels[i];
    if (met[i].tetrahedra != level.tetrahedra || met[i].vertices != level.vertices || met[i].boundaryTriangles != level.boundaryTriangles)
      return fail(ErrorCode::kBadValue, "level " + std::to_string(level.level) + " decodes to " +
                                            countsText(met[i].tetrahedra, met[i].vertices, met[i].boundaryTriangles) +
                                            ", the manifest says " + countsText(level.tetrahedra, level.vertices, level.boundaryTriangles) +
                                            "; build the log again");
  }
  return {};
}

/// The original's integers lie within the bits that the manifest states; those of coarser levels may leave them.
Status checkBits(const Manifest& manifest, const Refiner& finest) {
  for (std::uint32_t f = 0; f < manifest.fields.size(); ++f) {
    const std::int32_t end = std::int32_t{1} << manifest.fields[f].bits;
    const std::span<const std::int32_t> values = finest.fieldValues(f);
    const auto outside = std::ranges::find_if(values, [end](std::int32_t value) { return value < 0 || value >= end; });
    if (outside != values.end())
      return fail(ErrorCode::kBadValue, "field " + fieldKey(manifest, f) + " holds the integer " + std::to_string(*outside) +
                                            ", beyond the " + std::to_string(manifest.fields[f].bits) +
                                            " bits that the manifest says; build the log again");
  }
  return {};
}

}  // namespace

Result<Refiner> decodeVerified(const OpenedLog& log, const std::function<void(double fraction)>& progress) {
  if (Status checked = log.file.verifyChecksums(); !checked) return std::unexpected(checked.error());
  Refiner refiner(log.file.index());
  std::vector<std::uint32_t> fields(log.manifest.fields.size());
  std::iota(fields.begin(), fields.end(), 0u);
  const auto chunks = static_cast<std::uint32_t>(log.file.index().chunks.size());
  for (std::uint32_t chunk = 0; chunk < chunks; ++chunk) {
    if (Status applied = applyChunk(log.file, refiner, chunk, fields); !applied) return std::unexpected(applied.error());
    if (progress) progress((chunk + 1.0) / chunks);
  }
  if (Status levels = checkLevels(log.manifest.levels, refiner.levelCounts()); !levels)
    return std::unexpected(levels.error());
  if (Status bits = checkBits(log.manifest, refiner); !bits) return std::unexpected(bits.error());
  return refiner;
}

}  // namespace qtet
