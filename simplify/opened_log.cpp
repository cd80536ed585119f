#include "simplify/opened_log.h"

namespace qtet {
namespace {

Status agree(const LogIndex& index, const Manifest& manifest, const std::string& name) {
  const auto contradiction = [&](const std::string& what) {
    return fail(ErrorCode::kBadValue, name + ": manifest and chunk table contradict each other in " + what + "; build the log again");
  };
  if (index.chunks.empty() || manifest.levels.empty()) return contradiction("having no levels");
  if (manifest.fields.size() != index.fieldComponents.size()) return contradiction("the number of fields");
  for (std::size_t f = 0; f < manifest.fields.size(); ++f) {
    if (manifest.fields[f].components != index.fieldComponents[f])
      return contradiction("the components of field " + manifest.fields[f].name);
  }
  if (manifest.levels.size() != std::size_t{index.chunks.back().lastLevel} + 1) return contradiction("the number of levels");
  for (const ManifestLevel& level : manifest.levels) {
    if (level.chunk >= index.chunks.size()) return contradiction("the chunk of level " + std::to_string(level.level));
  }
  return {};
}

}  // namespace

std::uint64_t OpenedLog::prefixBytes(std::size_t level) const {
  const ChunkEntry& chunk = file.index().chunks[manifest.levels[level].chunk];
  return chunk.offset + chunk.size();
}

Result<OpenedLog> openLog(const std::filesystem::path& path) {
  Result<LogFile> file = LogFile::open(path);
  if (!file) return std::unexpected(file.error());
  Result<Manifest> manifest = manifestFromJson(file->index().manifest);
  if (!manifest) return std::unexpected(manifest.error());
  if (Status agreed = agree(file->index(), *manifest, path.string()); !agreed) return std::unexpected(agreed.error());
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
