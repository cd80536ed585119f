#include "codec/log/log_levels.h"

#include <cassert>

#include "codec/log/log_index.h"
#include "proto/level_error_json.h"
#include "proto/manifest.h"

namespace qtet {

std::uint64_t prefixBytes(const Manifest& manifest, const LogIndex& index, std::size_t level) {
  assert(level < manifest.levels.size() && manifest.levels[level].chunk < index.chunks.size());
  const ChunkEntry& chunk = index.chunks[manifest.levels[level].chunk];
  return chunk.offset + chunk.size();
}

nlohmann::ordered_json levelsJson(const Manifest& manifest, const LogIndex& index) {
  nlohmann::ordered_json out = nlohmann::ordered_json::array();
  const std::vector<bool> isLabel = labelsAmong(manifest);
  std::uint64_t before = 0;
  for (const ManifestLevel& level : manifest.levels) {
    const std::uint64_t prefix = prefixBytes(manifest, index, level.level);
    out.push_back({{"level", level.level},
                   {"tetrahedra", level.tetrahedra},
                   {"vertices", level.vertices},
                   {"boundaryTriangles", level.boundaryTriangles},
                   {"bytes", prefix - before},
                   {"cumulativeBytes", prefix}});
    if (level.error) out.back()["error"] = toJson(*level.error, isLabel);
    before = prefix;
  }
  return out;
}

}  // namespace qtet
