#include "server/http/upload_parts.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cassert>
#include <cerrno>
#include <iterator>

#include "codec/files/is_at.h"
#include "proto/log_digest.h"
#include "server/http/part_lock.h"
#include "server/http/upload_limits.h"

namespace qtet {
namespace {

namespace fs = std::filesystem;

// Hidden, so that no scan of the folder takes one for a mesh. Parts with a digest in their names
// can be resumed.
constexpr std::string_view kPrefix = ".upload-";
constexpr std::string_view kSuffix = ".part";

/// Between the prefix and the suffix; "" where it is no part.
std::string middleOf(const fs::path& path) {
  const std::string name = path.filename().string();
  if (name.size() <= kPrefix.size() + kSuffix.size() || !name.starts_with(kPrefix) ||
      !name.ends_with(kSuffix))
    return "";
  return name.substr(kPrefix.size(), name.size() - kPrefix.size() - kSuffix.size());
}

/// Unless an upload under way has it, of this server or another one.
void removePart(const fs::path& path) {
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK);
  if (file >= 0 && !isLocked(file) && isAt(path, file)) ::unlink(path.c_str());
  if (file >= 0) ::close(file);
}

Reply full(std::string_view detail) { return problem(507, "insufficient-storage", detail); }

}  // namespace

// The mesh's name is a part of it: who may write one mesh neither sees nor touches what is sent for
// another.
fs::path UploadParts::resumable(const std::string& id, const std::string& digest) const {
  return folder_ / (std::string(kPrefix) + digest + "-" + id + std::string(kSuffix));
}

fs::path UploadParts::nameless() {
  return folder_ / (std::string(kPrefix) + std::to_string(::getpid()) + "." +
                    std::to_string(next_++) + std::string(kSuffix));
}

std::vector<UploadParts::Part> UploadParts::kept(const fs::path& except) {
  std::vector<Part> out;
  seen_.clear();
  std::error_code ec;
  for (fs::directory_iterator it(folder_, ec), end; !ec && it != end; it.increment(ec)) {
    if (middleOf(it->path()).empty() || it->path() == except || underWay(it->path())) continue;
    const auto token = tokens_.find(it->path());
    std::error_code gone;
    Part part{it->path(), it->file_size(gone), it->last_write_time(gone),
              token == tokens_.end() ? "" : token->second};
    if (gone) continue;
    seen_.insert(part.path);
    out.push_back(std::move(part));
  }
  std::ranges::sort(out, {}, &Part::written);
  return out;
}

std::optional<Reply> UploadParts::begin(const UploadRequest& request, const fs::path& part) {
  assert(!underWay(part));
  const std::uintmax_t toCome = request.totalBytes - std::min(request.first, request.totalBytes);
  std::uintmax_t promised = quota_.reserve + toCome;
  for (const auto& [path, upload] : underWay_) promised += upload.toCome;
  std::vector<Part> others = kept(part);
  const auto bytesOf = [](const std::vector<Part>& parts) {
    std::uintmax_t out = 0;
    for (const Part& p : parts) out += p.bytes;
    return out;
  };
  const auto isOwn = [&](const Part& p) { return !p.token.empty() && p.token == request.token; };
  std::vector<Part> own;
  std::ranges::copy_if(others, std::back_inserter(own), isOwn);
  const auto tooMuch = [&] {
    return own.size() >= quota_.maxOfToken || bytesOf(own) + toCome > quota_.bytesOfToken ||
           others.size() >= quota_.most || bytesOf(others) + toCome > quota_.bytes ||
           quota_.freeBytes(folder_) < promised;
  };
  while (tooMuch() && !own.empty()) {  // its own, the oldest first: nobody else's
    const fs::path oldest = own.front().path;
    removePart(oldest);
    tokens_.erase(oldest);
    own.erase(own.begin());
    std::erase_if(others, [&](const Part& p) { return p.path == oldest; });
  }
  if (quota_.freeBytes(folder_) < promised)
    return full("the server's disk has too little left for this log; nothing was changed");
  if (tooMuch())
    return full(
        "uploads that broke off take as much as they may; they are kept for a day, come back "
        "later");
  std::erase_if(tokens_, [&](const auto& entry) {
    return !underWay(entry.first) &&
           std::ranges::find(others, entry.first, &Part::path) == others.end();
  });
  tokens_[part] = request.token;
  underWay_[part] = {request.token, toCome};
  seen_.erase(part);
  return std::nullopt;
}

void UploadParts::end(const fs::path& part) {
  assert(underWay(part));
  underWay_.erase(part);
  seen_.insert(part);
}

std::uintmax_t UploadParts::bytes() const {
  std::uintmax_t out = 0;
  const auto add = [&out](const fs::path& path) {
    std::error_code gone;
    if (const std::uintmax_t size = fs::file_size(path, gone); !gone) out += size;
  };
  for (const fs::path& path : seen_) add(path);
  for (const auto& [path, upload] : underWay_) add(path);
  return out;
}

std::size_t UploadParts::countUnderWay(const std::string& token) const {
  return static_cast<std::size_t>(std::ranges::count_if(
      underWay_, [&](const auto& entry) { return entry.second.token == token; }));
}

void UploadParts::removeOld(std::chrono::seconds ofNoDigest) {
  const auto now = fs::file_time_type::clock::now();
  for (const Part& part : kept({})) {
    const std::string middle = middleOf(part.path);
    const auto most = isLogDigest(std::string_view(middle).substr(0, middle.find('-')))
                          ? std::chrono::seconds(limits::kPartialUploadTime)
                          : ofNoDigest;
    if (now - part.written > most) removePart(part.path);
  }
}

}  // namespace qtet
