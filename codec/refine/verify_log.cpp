#include "codec/refine/verify_log.h"

#include <algorithm>
#include <cassert>
#include <numeric>
#include <string>

#include "codec/refine/log_file.h"
#include "codec/refine/refiner.h"
#include "proto/manifest.h"

namespace qtet {
namespace {

std::string countsText(std::size_t tetrahedra, std::size_t vertices, std::size_t boundary) {
  return std::to_string(tetrahedra) + " tetrahedra, " + std::to_string(vertices) +
         " vertices and " + std::to_string(boundary) + " boundary triangles";
}

/// Compares the manifest's statement of every level with the counts that the refiner met.
Status checkLevels(const std::vector<ManifestLevel>& levels, std::span<const LevelCounts> met) {
  if (levels.size() != met.size())
    return fail(ErrorCode::kBadValue, "the log holds " + std::to_string(met.size()) +
                                          " levels, the manifest lists " +
                                          std::to_string(levels.size()) + "; build the log again");
  for (std::size_t i = 0; i < levels.size(); ++i) {
    const ManifestLevel& level = levels[i];
    if (met[i].tetrahedra != level.tetrahedra || met[i].vertices != level.vertices ||
        met[i].boundaryTriangles != level.boundaryTriangles)
      return fail(ErrorCode::kBadValue,
                  "level " + std::to_string(level.level) + " decodes to " +
                      countsText(met[i].tetrahedra, met[i].vertices, met[i].boundaryTriangles) +
                      ", the manifest says " +
                      countsText(level.tetrahedra, level.vertices, level.boundaryTriangles) +
                      "; build the log again");
  }
  return {};
}

/// The original's integers lie within the bits that the manifest states; those of coarser levels
/// may leave them.
Status checkBits(const Manifest& manifest, const Refiner& finest) {
  for (std::uint32_t f = 0; f < manifest.fields.size(); ++f) {
    const std::int32_t end = std::int32_t{1} << manifest.fields[f].bits;
    const std::span<const std::int32_t> values = finest.fieldValues(f);
    const auto outside = std::ranges::find_if(values, [end](std::int32_t value) {
      return value != kMissing && (value < 0 || value >= end);
    });
    if (outside != values.end())
      return fail(ErrorCode::kBadValue, "field " + fieldKey(manifest, f) + " holds the integer " +
                                            std::to_string(*outside) + ", beyond the " +
                                            std::to_string(manifest.fields[f].bits) +
                                            " bits that the manifest says; build the log again");
  }
  return {};
}

class Gate final : public LevelGate {
 public:
  Gate(const std::function<bool(double)>& ask, std::size_t chunks)
      : ask_(ask), chunks_(static_cast<double>(chunks)) {}
  bool goOn() override { return !ask_ || ask_(done_ / chunks_); }
  bool chunkIsDone() {
    ++done_;
    return goOn();
  }

 private:
  const std::function<bool(double)>& ask_;
  double chunks_, done_ = 0;
};

}  // namespace

Result<Refiner> decodeVerified(const LogFile& log, const Manifest& manifest,
                               const std::function<bool(double fraction)>& goOn) {
  assert(manifest.fields.size() == log.fields().size());
  if (Status checked = log.verifyChecksums(); !checked) return std::unexpected(checked.error());
  Refiner refiner(log.index());
  Gate gate(goOn, log.chunks().size());
  refiner.askBeforeLevels(&gate);
  std::vector<std::uint32_t> fields(manifest.fields.size());
  std::iota(fields.begin(), fields.end(), 0u);
  const auto chunks = static_cast<std::uint32_t>(log.chunks().size());
  for (std::uint32_t chunk = 0; chunk < chunks; ++chunk) {
    if (Status applied = applyChunk(log, refiner, chunk, fields); !applied)
      return std::unexpected(applied.error());
    if (!gate.chunkIsDone()) return fail(ErrorCode::kIo, "stopped, as was asked for");
  }
  refiner.askBeforeLevels(nullptr);
  if (Status levels = checkLevels(manifest.levels, refiner.levelCounts()); !levels)
    return std::unexpected(levels.error());
  if (Status bits = checkBits(manifest, refiner); !bits) return std::unexpected(bits.error());
  return refiner;
}

}  // namespace qtet
