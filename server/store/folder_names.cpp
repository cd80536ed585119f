#include "server/store/folder_names.h"

#include <algorithm>
#include <cerrno>

namespace qtet {
namespace {

namespace fs = std::filesystem;

/// Names between two looks at the clock.
constexpr std::size_t kNamesBetween = 256;

std::unexpected<Error> unreadable(const fs::path& folder, const std::error_code& why) {
  return fail(ErrorCode::kIo,
              folder.string() + ": " + why.message() + "; name a folder that holds .qtet files");
}

}  // namespace

bool isServable(const fs::path& path, const fs::path& root) {
  std::error_code ec;
  if (!fs::is_regular_file(path, ec)) return false;
  if (!fs::is_symlink(path, ec)) return !ec;
  const fs::path real = fs::canonical(path, ec);
  return !ec && std::ranges::mismatch(root, real).in1 == root.end();
}

Result<FolderNames> FolderNames::open(const fs::path& folder) {
  std::error_code ec;
  const fs::path root = fs::canonical(folder, ec);
  if (ec) return unreadable(folder, ec);
  DIR* opened = ::opendir(root.c_str());
  if (opened == nullptr) return unreadable(folder, {errno, std::generic_category()});
  return FolderNames(root, opened);
}

Result<bool> FolderNames::read(Clock::time_point end) {
  for (std::size_t count = 1;; ++count) {
    errno = 0;
    const dirent* entry = ::readdir(folder_.get());
    if (entry == nullptr && errno != 0) return unreadable(root_, {errno, std::generic_category()});
    if (entry == nullptr) return true;
    const std::string_view name = entry->d_name;
    // Other kinds are links, or the file system does not say: only these cost a look at the file.
    if (name.ends_with(kLogSuffix) && !name.starts_with('.') && entry->d_type != DT_DIR &&
        (entry->d_type == DT_REG || isServable(root_ / name, root_)))
      ids_.emplace_back(name.substr(0, name.size() - kLogSuffix.size()));
    if (count % kNamesBetween == 0 && Clock::now() >= end) return false;
  }
}

std::vector<std::string> FolderNames::take() && {
  std::ranges::sort(ids_);
  ids_.erase(std::unique(ids_.begin(), ids_.end()), ids_.end());
  return std::move(ids_);
}

}  // namespace qtet
