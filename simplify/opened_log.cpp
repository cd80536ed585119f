#include "simplify/opened_log.h"

#include "codec/log_manifest.h"

namespace qtet {

std::uint64_t OpenedLog::prefixBytes(std::size_t level) const {
  const ChunkEntry& chunk = file.index().chunks[manifest.levels[level].chunk];
  return chunk.offset + chunk.size();
}

Result<OpenedLog> openLog(const std::filesystem::path& path) {
  Result<LogFile> file = LogFile::open(path);
  if (!file) return std::unexpected(file.error());
  Result<Manifest> manifest = manifestOf(file->index());
  if (!manifest) {
    manifest.error().message = path.string() + ": " + manifest.error().message;
    return std::unexpected(manifest.error());
  }
  return OpenedLog{std::move(*file), std::move(*manifest)};
}

OrderedJson levelsJson(const OpenedLog& log) {
  OrderedJson out = OrderedJson::array();
  std::uint64_t before = 0;
  for (std::size_t i = 0; i < log.manifest.levels.size(); ++i) {
    const ManifestLevel& level = log.manifest.levels[i];
    const std::uint64_t prefix = log.prefixBytes(i);
    out.push_back({{"level", level.level},
                   {"tetrahedra", level.tetrahedra},
                   {"vertices", level.vertices},
                   {"boundaryTriangles", level.boundaryTriangles},
                   {"bytes", prefix - before},
                   {"cumulativeBytes", prefix}});
    before = prefix;
  }
  return out;
}

}  // namespace qtet
