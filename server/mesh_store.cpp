#include "server/mesh_store.h"

#include <sys/stat.h>

#include <algorithm>

#include "codec/log_levels.h"
#include "codec/log_manifest.h"

namespace qtet {
namespace {

namespace fs = std::filesystem;

std::time_t modificationTime(const fs::path& path) {
  struct stat info {};
  return ::stat(path.c_str(), &info) == 0 ? info.st_mtime : 0;
}

}  // namespace

std::uint64_t ServedMesh::prefixBytes(std::uint32_t level) const {
  return qtet::prefixBytes(manifest, log.index(), level);
}

Result<ServedMesh> openMesh(const fs::path& path) {
  Result<LogFile> log = LogFile::open(path);
  if (!log) return std::unexpected(log.error());
  if (const Status whole = log->verifyChecksums(); !whole) return std::unexpected(whole.error());
  Result<Manifest> manifest = manifestOf(log->index());
  if (!manifest) return std::unexpected(manifest.error());
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
