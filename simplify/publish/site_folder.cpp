#include "simplify/publish/site_folder.h"

#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>
#include <cassert>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>
#include <utility>

#include "codec/files/atomic_file.h"
#include "codec/files/unreachable.h"

namespace qtet {
namespace {

namespace fs = std::filesystem;

Status systemError(const std::string& what, const fs::path& path, int number) {
  return fail(ErrorCode::kIo,
              "cannot " + what + " " + path.string() + ": " + std::strerror(number));
}

/// The files of an earlier publication; empty where there was none.
std::set<std::string> publishedFiles(const fs::path& folder) {
  std::ifstream file(folder / kSiteList, std::ios::binary);
  const auto list = nlohmann::json::parse(file, nullptr, false);
  if (!list.is_object() || !list.contains("files") || !list["files"].is_array()) return {};
  std::set<std::string> names;
  for (const nlohmann::json& name : list["files"])
    if (name.is_string()) names.insert(name.get<std::string>());
  return names;
}

/// The first thing in the folder that an earlier publication did not make; empty: nothing.
Result<std::string> strangerIn(const fs::path& folder) {
  const std::set<std::string> ours = publishedFiles(folder);
  std::error_code code;
  for (fs::recursive_directory_iterator at(folder, code), end; !code && at != end;
       at.increment(code)) {
    const std::string name = at->path().lexically_relative(folder).generic_string();
    std::error_code unknown;
    const bool isFolder = fs::is_directory(at->symlink_status(unknown));
    if (!isFolder && !ours.contains(name)) return name;
  }
  if (code)
    return fail(ErrorCode::kIo, "cannot read the folder " + folder.string() + ": " +
                                    code.message() + "; publish to another one");
  return std::string();
}

Status checkPlace(const fs::path& place) {
  std::error_code code;
  const fs::path parent = place.parent_path();
  const bool isThere = fs::is_directory(parent, code);
  if (isUnreachable(code))
    return fail(ErrorCode::kIo, "the folder " + parent.string() + " cannot be reached: " +
                                    code.message() + "; publish elsewhere");
  if (!isThere)
    return fail(ErrorCode::kNotFound, "the folder " + parent.string() +
                                          " does not exist; make it first or publish elsewhere");
  if (!fs::exists(place, code)) return {};
  if (!fs::is_directory(place, code))
    return fail(ErrorCode::kIo, place.string() + " is no folder; publish to another name");
  const Result<std::string> stranger = strangerIn(place);
  if (!stranger) return std::unexpected(stranger.error());
  if (stranger->empty()) return {};
  return fail(ErrorCode::kIo, "the folder " + place.string() + " holds " + *stranger +
                                  ", which no earlier 'qtet publish' made; publish to another "
                                  "folder, or move that away");
}

/// "site/" names what "site" does, but neither a link nor a last name are seen in it.
fs::path withoutSlash(fs::path path) { return path.has_filename() ? path : path.parent_path(); }

/// mkdtemp's folders are for their owner alone; a web server is another user.
mode_t folderMode() {
  const mode_t mask = ::umask(0);
  ::umask(mask);
  return 0777 & ~mask;
}

/// For file systems without an exchange: between the two renames nothing is there.
Status replaceInTwoSteps(const fs::path& hidden, const fs::path& place) {
  const fs::path old = hidden.string() + ".old";
  if (::rename(place.c_str(), old.c_str()) != 0)
    return systemError("move the old folder away from", place, errno);
  if (::rename(hidden.c_str(), place.c_str()) != 0) {
    const int number = errno;
    (void)::rename(old.c_str(), place.c_str());
    return systemError("rename a new folder to", place, number);
  }
  // the destructor removes what has this name
  if (::rename(old.c_str(), hidden.c_str()) != 0)
    return systemError("remove the old folder", old, errno);
  return {};
}

Status putInPlace(const fs::path& hidden, const fs::path& place) {
  if (::access(place.c_str(), F_OK) != 0)
    return ::rename(hidden.c_str(), place.c_str()) == 0
               ? Status{}
               : systemError("rename a new folder to", place, errno);
#ifdef RENAME_EXCHANGE
  if (::renameat2(AT_FDCWD, hidden.c_str(), AT_FDCWD, place.c_str(), RENAME_EXCHANGE) == 0)
    return {};
  if (errno != EINVAL && errno != ENOSYS) return systemError("replace the folder", place, errno);
#endif
  return replaceInTwoSteps(hidden, place);
}

}  // namespace

SiteFolder::SiteFolder(SiteFolder&& other) noexcept
    : place_(std::move(other.place_)),
      hidden_(std::exchange(other.hidden_, {})),
      files_(std::move(other.files_)) {}

SiteFolder::~SiteFolder() {
  std::error_code ignored;
  if (!hidden_.empty()) fs::remove_all(hidden_, ignored);
}

Result<Bytes> readWhole(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  Bytes out{std::istreambuf_iterator<char>(in), {}};
  if (!in.is_open() || in.bad())
    return fail(ErrorCode::kIo, path.string() + " cannot be read; check its permissions");
  return out;
}

Result<SiteFolder> SiteFolder::begin(const fs::path& place) {
  std::error_code code;
  const Result<fs::path> behind =
      fileBehindLinks(withoutSlash(fs::absolute(place, code).lexically_normal()));
  if (!behind) return std::unexpected(behind.error());
  SiteFolder out;
  out.place_ = withoutSlash(*behind);
  if (Status checked = checkPlace(out.place_); !checked) return std::unexpected(checked.error());
  std::string hidden =
      (out.place_.parent_path() / ("." + out.place_.filename().string() + ".XXXXXX")).string();
  if (::mkdtemp(hidden.data()) == nullptr)
    return std::unexpected(systemError("make a folder like", hidden, errno).error());
  out.hidden_ = hidden;
  if (::chmod(hidden.c_str(), folderMode()) != 0)
    return std::unexpected(systemError("open to others the folder", hidden, errno).error());
  return out;
}

Status SiteFolder::write(const std::string& name, ByteView bytes) {
  assert(!name.empty() && fs::path(name).is_relative());
  const fs::path path = hidden_ / name;
  std::error_code code;
  fs::create_directories(path.parent_path(), code);
  if (code) return systemError("make the folder", path.parent_path(), code.value());
  files_.insert(name);
  return writeFileAtomically(path, bytes);
}

Status SiteFolder::finish() {
  // Somebody may have put something there meanwhile.
  if (Status checked = checkPlace(place_); !checked) return checked;
  const bool replaces = ::access(place_.c_str(), F_OK) == 0;
  if (Status put = putInPlace(hidden_, place_); !put) return put;
  if (!replaces) hidden_.clear();
  const int parent = ::open(place_.parent_path().c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (parent < 0) return {};
  (void)::fsync(parent);  // as far as the file system can
  ::close(parent);
  return {};
}

}  // namespace qtet
