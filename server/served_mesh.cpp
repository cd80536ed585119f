#include "server/served_mesh.h"

#include <sys/stat.h>

#include <atomic>
#include <fstream>

#include "codec/log_levels.h"
#include "codec/log_manifest.h"
#include "server/descriptions.h"
#include "server/limits.h"

namespace qtet {

std::uint64_t ServedMesh::prefixBytes(std::uint32_t level) const {
  return qtet::prefixBytes(manifest, log.index(), level);
}

std::optional<FileIdentity> identityOf(const std::filesystem::path& path) {
  struct stat info {};
  if (::stat(path.c_str(), &info) != 0 || !S_ISREG(info.st_mode)) return std::nullopt;
  return FileIdentity{info.st_dev, info.st_ino, info.st_size, info.st_mtim};
}

namespace {

std::atomic<std::uintmax_t> copiedBytes = 0;

/// A part of what may be copied, given back with the last copy of the pointer; nullptr: there is not enough left.
std::shared_ptr<void> takeCopy(std::uintmax_t bytes) {
  if (bytes > limits::kMaxCopiedLogBytes) return nullptr;
  if (copiedBytes.fetch_add(bytes) + bytes > limits::kMaxCopiedBytes) return copiedBytes.fetch_sub(bytes), nullptr;
  return {&copiedBytes, [bytes](void*) { copiedBytes.fetch_sub(bytes); }};
}

Result<LogFile> readLog(const std::filesystem::path& path, std::uintmax_t size) {
  std::ifstream in(path, std::ios::binary);
  Bytes bytes(static_cast<std::size_t>(size));
  in.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(size));
  if (!in) return fail(ErrorCode::kIo, path.string() + ": cannot be read, or has changed meanwhile");
  Result<LogFile> log = LogFile::fromBytes(std::move(bytes));
  if (!log) log.error().message = path.string() + ": " + log.error().message;
  return log;
}

}  // namespace

Result<MeshPointer> openMesh(const std::filesystem::path& path, std::string id) {
  // Asked first: a file that changes while it is read differs from this identity, and is opened again.
  const FileIdentity file = identityOf(path).value_or(FileIdentity());
  const auto size = static_cast<std::uintmax_t>(file.bytes);
  std::shared_ptr<void> copied = size > 0 ? takeCopy(size) : nullptr;
  Result<LogFile> log = copied ? readLog(path, size) : LogFile::open(path);
  if (!log) return std::unexpected(log.error());
  if (const Status whole = log->verifyChecksums(); !whole) return std::unexpected(whole.error());
  Result<Manifest> manifest = manifestOf(log->index());
  if (!manifest) return std::unexpected(manifest.error());
  auto out = std::make_shared<ServedMesh>(ServedMesh{std::move(id), std::move(*log), std::move(*manifest), file.modified.tv_sec, file});
  out->copied = std::move(copied);
  out->listEntry = describeEntry(*out);
  out->description = Document(describeMesh(*out));
  out->manifestText = Document(manifestToJson(out->manifest));
  return out;
}

}  // namespace qtet
