#include "server/served_mesh.h"

#include <sys/stat.h>

#include "codec/log_levels.h"
#include "codec/log_manifest.h"
#include "server/descriptions.h"

namespace qtet {

std::uint64_t ServedMesh::prefixBytes(std::uint32_t level) const {
  return qtet::prefixBytes(manifest, log.index(), level);
}

std::optional<FileIdentity> identityOf(const std::filesystem::path& path) {
  struct stat info {};
  if (::stat(path.c_str(), &info) != 0 || !S_ISREG(info.st_mode)) return std::nullopt;
  return FileIdentity{info.st_dev, info.st_ino, info.st_size, info.st_mtim};
}

Result<MeshPointer> openMesh(const std::filesystem::path& path, std::string id) {
  // Asked first: a file that changes while it is read differs from this identity, and is opened again.
  const FileIdentity file = identityOf(path).value_or(FileIdentity());
  Result<LogFile> log = LogFile::open(path);
  if (!log) return std::unexpected(log.error());
  if (const Status whole = log->verifyChecksums(); !whole) return std::unexpected(whole.error());
  Result<Manifest> manifest = manifestOf(log->index());
  if (!manifest) return std::unexpected(manifest.error());
  auto out = std::make_shared<ServedMesh>(ServedMesh{std::move(id), std::move(*log), std::move(*manifest), file.modified.tv_sec, file});
  out->listEntry = describeEntry(*out);
  out->description = Document(describeMesh(*out));
  out->manifestText = Document(manifestToJson(out->manifest));
  return out;
}

}  // namespace qtet
