#include "server/mesh_store.h"

#include <sys/stat.h>

#include <algorithm>

namespace qtet {
namespace {

namespace fs = std::filesystem;

/// The manifest is for people and the table for decoders; a log in which they disagree would be shown wrong.
Status checkAgreement(const Manifest& manifest, const LogIndex& index) {
  const auto disagree = [](const std::string& what) { return fail(ErrorCode::kBadValue, what + "; build the log again"); };
  if (manifest.fields.size() != index.fieldComponents.size())
    return disagree("the manifest has " + std::to_string(manifest.fields.size()) + " fields and the chunk table " +
                    std::to_string(index.fieldComponents.size()));
  for (std::size_t f = 0; f < manifest.fields.size(); ++f)
    if (manifest.fields[f].components != index.fieldComponents[f])
      return disagree("field '" + manifest.fields[f].name + "' has " + std::to_string(manifest.fields[f].components) +
                      " components in the manifest and " + std::to_string(index.fieldComponents[f]) + " in the chunk table");
  if (manifest.levels.back().chunk >= index.chunks.size())
    return disagree("the manifest's last level ends in chunk " + std::to_string(manifest.levels.back().chunk) + " and there are only " +
                    std::to_string(index.chunks.size()));
  return {};
}

std::time_t modificationTime(const fs::path& path) {
  struct stat info {};
  return ::stat(path.c_str(), &info) == 0 ? info.st_mtime : 0;
}

}  // namespace

std::uint64_t ServedMesh::prefixBytes(std::uint32_t level) const {
  const ChunkEntry& chunk = log.index().chunks[manifest.levels[level].chunk];
  return chunk.offset + chunk.size();
}

Result<ServedMesh> openMesh(const fs::path& path) {
  Result<LogFile> log = LogFile::open(path);
  if (!log) return std::unexpected(log.error());
  if (const Status whole = log->verifyChecksums(); !whole) return std::unexpected(whole.error());
  Result<Manifest> manifest = manifestFromJson(log->index().manifest);
  if (!manifest) return std::unexpected(manifest.error());
  if (const Status agreed = checkAgreement(*manifest, log->index()); !agreed) return std::unexpected(agreed.error());
  return ServedMesh{path.stem().string(), std::move(*log), std::move(*manifest), modificationTime(path)};
}

Result<MeshStore> MeshStore::open(const fs::path& folder) {
  std::error_code ec;
  std::vector<fs::path> paths;
  for (fs::directory_iterator it(folder, ec), end; !ec && it != end; it.increment(ec))
    if (it->path().extension() == ".qtet" && it->is_regular_file()) paths.push_back(it->path());
  if (ec) return fail(ErrorCode::kIo, folder.string() + ": " + ec.message() + "; name a folder that holds .qtet files");
  std::ranges::sort(paths);

  MeshStore out;
  for (const fs::path& path : paths) {
    Result<ServedMesh> mesh = openMesh(path);
    if (!mesh) {
      out.refused_.push_back({path, mesh.error()});
      continue;
    }
    std::string id = mesh->id;
    out.meshes_.emplace(std::move(id), std::move(*mesh));
  }
  return out;
}

const ServedMesh* MeshStore::find(std::string_view id) const {
  const auto it = meshes_.find(id);
  return it == meshes_.end() ? nullptr : &it->second;
}

}  // namespace qtet
