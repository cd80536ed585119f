#include "simplify/log/opened_log.h"

#include <cassert>

#include "codec/log/log_levels.h"
#include "codec/log/log_manifest.h"

namespace qtet {

std::uint64_t OpenedLog::prefixBytes(std::size_t level) const {
  assert(level < manifest.levels.size());
  return qtet::prefixBytes(manifest, file.index(), level);
}

Result<OpenedLog> openLog(const std::filesystem::path& path) {
  Result<LogFile> file = LogFile::open(path);
  if (!file) {
    if (file.error().code == ErrorCode::kBadMagic)
      file.error().message +=
          "; 'qtet check' tells what a mesh holds, 'qtet simplify' makes a log of it";
    return std::unexpected(file.error());
  }
  Result<Manifest> manifest = manifestOf(file->index());
  if (!manifest) {
    manifest.error().message = path.string() + ": " + manifest.error().message;
    return std::unexpected(manifest.error());
  }
  return OpenedLog{std::move(*file), std::move(*manifest)};
}

}  // namespace qtet
