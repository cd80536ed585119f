#include "codec/refine/verify_log.h"

#include <algorithm>
#include <cassert>
#include <numeric>
#include <string>
#include <vector>

#include "codec/log/last_uses.h"
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
Status checkBits(const Manifest& manifest, const Refiner& finest, std::uint32_t f) {
  const std::int32_t end = std::int32_t{1} << manifest.fields[f].bits;
  const std::span<const std::int32_t> values = finest.fieldValues(f);
  const auto outside = std::ranges::find_if(values, [end](std::int32_t value) {
    return value != kMissing && (value < 0 || value >= end);
  });
  if (outside == values.end()) return {};
  return fail(ErrorCode::kBadValue, "field " + fieldKey(manifest, f) + " holds the integer " +
                                        std::to_string(*outside) + ", beyond the " +
                                        std::to_string(manifest.fields[f].bits) +
                                        " bits that the manifest says; build the log again");
}

class Gate final : public LevelGate {
 public:
  Gate(const std::function<bool(double)>& ask, std::uint64_t bytes)
      : ask_(ask), bytes_(static_cast<double>(bytes)) {}
  bool goOn() override { return !ask_ || ask_(std::min(done_ / bytes_, 1.0)); }
  Status isDone(std::uint64_t bytes) {
    done_ += static_cast<double>(bytes);
    return goOn() ? Status{} : fail(ErrorCode::kIo, "stopped, as was asked for");
  }

 private:
  const std::function<bool(double)>& ask_;
  double bytes_, done_ = 0;
};

/// Decodes the fields of a refiner that has the whole mesh.
Status verifyFields(const LogFile& log, const Manifest& manifest, Refiner& refiner, Gate& gate,
                    Verified left) {
  std::vector<std::uint32_t> fields(log.fields().size());
  std::iota(fields.begin(), fields.end(), 0u);
  const std::vector<std::vector<std::uint32_t>> uses = lastUses(log.fields(), fields);
  for (const std::uint32_t f : fields) {
    for (std::uint32_t chunk = 0; chunk < log.chunks().size(); ++chunk) {
      if (Status s = applyFieldBlock(log, refiner, chunk, f); !s) return s;
      if (Status s = gate.isDone(log.chunks()[chunk].blocks[kFirstFieldPart + f].size); !s)
        return s;
    }
    if (Status s = checkBits(manifest, refiner, f); !s) return s;
    if (left == Verified::kFields) continue;
    for (const std::uint32_t used : uses[f]) refiner.forgetField(used);
  }
  return {};
}

}  // namespace

Result<Refiner> decodeVerified(const LogFile& log, const Manifest& manifest,
                               const std::function<bool(double fraction)>& goOn, Verified left) {
  assert(manifest.fields.size() == log.fields().size());
  if (Status checked = log.verifyChecksums(); !checked) return std::unexpected(checked.error());
  Refiner refiner(log.index());
  Gate gate(goOn, log.bytes().size() - log.headBytes());
  refiner.askBeforeLevels(&gate);
  for (std::uint32_t chunk = 0; chunk < log.chunks().size(); ++chunk) {
    if (Status s = applyChunk(log, refiner, chunk, {}); !s) return std::unexpected(s.error());
    const std::vector<BlockEntry>& blocks = log.chunks()[chunk].blocks;
    const std::uint64_t bytes =
        std::uint64_t{blocks[kStructurePart].size} + blocks[kPositionsPart].size;
    if (Status s = gate.isDone(bytes); !s) return std::unexpected(s.error());
  }
  refiner.askBeforeLevels(nullptr);
  if (Status levels = checkLevels(manifest.levels, refiner.levelCounts()); !levels)
    return std::unexpected(levels.error());
  if (Status s = verifyFields(log, manifest, refiner, gate, left); !s)
    return std::unexpected(s.error());
  return refiner;
}

}  // namespace qtet
