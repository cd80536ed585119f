#include "server/store/level_cache.h"

#include <fcntl.h>
#include <spdlog/spdlog.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cassert>
#include <tuple>
#include <vector>

#include "codec/files/atomic_file.h"
#include "proto/crc32c.h"

namespace qtet {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kSuffix = ".level";
constexpr std::size_t kKeyCharacters = 64;

/// Behind the level's bytes in its file: these four, and the CRC-32C of the level.
constexpr std::string_view kMark = "QLV1";
constexpr std::size_t kSealBytes = 8;

Bytes sealOf(ByteView level) {
  ByteWriter out;
  for (const char c : kMark) out.write(static_cast<std::uint8_t>(c));
  out.write(crc32c(level));
  return out.take();
}

/// The file as it lies there, seal and all.
std::optional<LevelFile> mapFile(const fs::path& path) {
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW);
  if (file < 0) return std::nullopt;
  struct stat info{};
  void* address = MAP_FAILED;
  const bool sound = ::fstat(file, &info) == 0 && S_ISREG(info.st_mode) && info.st_size > 0;
  if (sound)
    address =
        ::mmap(nullptr, static_cast<std::size_t>(info.st_size), PROT_READ, MAP_SHARED, file, 0);
  ::close(file);
  if (address == MAP_FAILED) return std::nullopt;
  const auto size = static_cast<std::size_t>(info.st_size);
  return LevelFile{{static_cast<const std::uint8_t*>(address), size},
                   {address, [size](void* mapped) { ::munmap(mapped, size); }}};
}

/// Without its seal; nullopt: it is not what was written.
std::optional<LevelFile> unsealed(LevelFile file) {
  if (file.bytes.size() < kSealBytes) return std::nullopt;
  const ByteView level = file.bytes.first(file.bytes.size() - kSealBytes);
  if (!std::ranges::equal(sealOf(level), file.bytes.last(kSealBytes))) return std::nullopt;
  file.bytes = level;
  return file;
}

bool isKey(std::string_view text) {
  return text.size() == kKeyCharacters &&
         text.find_first_not_of("0123456789abcdef") == std::string_view::npos;
}

}  // namespace

Result<std::unique_ptr<LevelCache>> LevelCache::open(const fs::path& folder,
                                                     std::uintmax_t maxBytes,
                                                     std::uintmax_t reserve,
                                                     FreeDiskBytes freeBytes,
                                                     std::size_t maxLevels) {
  std::error_code ec;
  fs::create_directories(folder, ec);
  std::vector<std::tuple<fs::file_time_type, std::string, std::uintmax_t>> found;
  for (fs::directory_iterator it(folder, ec), end; !ec && it != end; it.increment(ec)) {
    const std::string key = it->path().stem().string();
    std::error_code gone;
    if (it->path().extension() == kSuffix && isKey(key))
      found.emplace_back(it->last_write_time(gone), key,
                         std::max<std::uintmax_t>(it->file_size(gone), kSealBytes) - kSealBytes);
  }
  if (ec || ::access(folder.c_str(), W_OK | X_OK) != 0)
    return fail(
        ErrorCode::kIo,
        folder.string() + " cannot keep levels; name a folder that may be written with --cache");
  // Another server may keep its levels here, too: what it is writing it has locked.
  removeUnfinished(folder, [](std::string_view name) {
    return name.ends_with(kSuffix) && isKey(name.substr(0, name.size() - kSuffix.size()));
  });
  std::ranges::sort(found);
  std::unique_ptr<LevelCache> out(
      new LevelCache(folder, maxBytes, reserve, std::move(freeBytes), maxLevels));
  for (const auto& [time, key, bytes] : found) out->add(key, bytes);
  return out;
}

fs::path LevelCache::pathOf(const std::string& key) const {
  assert(isKey(key));
  return folder_ / (key + std::string(kSuffix));
}

void LevelCache::add(const std::string& key, std::uintmax_t bytes) {
  forget(key);
  entries_.push_front({key, bytes});
  byKey_[key] = entries_.begin();
  bytes_ += bytes;
  // whoever is sending one has it mapped
  while (bytes_ > maxBytes_ || entries_.size() > maxLevels_)
    discard(std::string(entries_.back().key));
  assert(byKey_.size() == entries_.size() && open_ <= entries_.size());
}

void LevelCache::forget(const std::string& key) {
  const auto it = byKey_.find(key);
  if (it == byKey_.end()) return;
  assert(it->second->bytes <= bytes_ && it->second->open.has_value() <= open_);
  bytes_ -= it->second->bytes;
  open_ -= it->second->open.has_value();
  entries_.erase(it->second);
  byKey_.erase(it);
}

void LevelCache::discard(const std::string& key) {
  std::error_code ec;
  fs::remove(pathOf(key), ec);
  forget(key);
}

void LevelCache::hold(Entry& entry, const LevelFile& level, const FileIdentity& file) {
  assert(level.bytes.size() == entry.bytes);
  open_ += !entry.open.has_value();
  entry.open = level, entry.file = file;
  for (auto it = entries_.rbegin(); open_ > limits::kMaxOpenLevels; ++it)
    if (it->open && &*it != &entry) it->open.reset(), --open_;
}

KeptAnswer LevelCache::atHand(const std::string& key) {
  const std::scoped_lock lock(mutex_);
  const auto it = byKey_.find(key);
  if (it == byKey_.end() || !it->second->open) return std::nullopt;
  Entry& entry = *it->second;
  if (identityOf(pathOf(key)) != entry.file) {  // somebody else has written there
    entry.open.reset(), --open_;
    return std::nullopt;
  }
  entries_.splice(entries_.begin(), entries_, it->second);
  return *entry.open;
}

bool LevelCache::has(const std::string& key) const {
  const std::scoped_lock lock(mutex_);
  return byKey_.contains(key);
}

KeptAnswer LevelCache::find(const std::string& key) {
  if (KeptAnswer out = atHand(key)) return out;
  if (!has(key)) return std::nullopt;
  // Reading it all takes long, so others may look meanwhile.
  std::error_code ec;
  fs::last_write_time(pathOf(key), fs::file_time_type::clock::now(), ec);  // orders the next run
  const auto file = identityOf(pathOf(key));
  std::optional<LevelFile> out = mapFile(pathOf(key));
  if (out) out = unsealed(std::move(*out));
  const std::scoped_lock lock(mutex_);
  const auto it = byKey_.find(key);
  if (it == byKey_.end()) return out ? KeptAnswer(std::move(*out)) : std::nullopt;
  // also where no file can be opened now: what is not counted any more may not lie there
  if (!out || !file || out->bytes.size() != it->second->bytes) {
    discard(key);
    return std::nullopt;
  }
  entries_.splice(entries_.begin(), entries_, it->second);
  hold(*it->second, *out, *file);
  return std::move(*out);
}

Result<LevelFile> LevelCache::put(const std::string& key, Result<LevelFile> made) {
  if (!made) return made;
  const LevelFile& level = *made;
  const std::size_t size = level.bytes.size();
  if (size == 0 || size > maxBytes_ || freeBytes_(folder_) < reserve_ + size + kSealBytes)
    return made;
  const Bytes seal = sealOf(level.bytes);
  const ByteSource content = [&](const ByteSink& sink) {
    const Status done = sink(level.bytes);
    return done ? sink(seal) : done;
  };
  // the folder may hold many files, and open() has removed what writers before left
  if (const Status written =
          writeFileAtomically(pathOf(key), content, systemFileCalls(), Leftovers::kKeep);
      !written) {
    spdlog::warn("a level is not kept: {}", written.error().message);
    return made;
  }
  const std::scoped_lock lock(mutex_);
  const auto file = identityOf(pathOf(key));
  std::optional<LevelFile> out = mapFile(pathOf(key));
  add(key, size);
  if (!out || !file || out->bytes.size() != size + kSealBytes) return made;
  out->bytes = out->bytes.first(size);
  if (const auto it = byKey_.find(key); it != byKey_.end()) hold(*it->second, *out, *file);
  return std::move(*out);
}

std::uintmax_t LevelCache::bytes() const {
  const std::scoped_lock lock(mutex_);
  return bytes_;
}

}  // namespace qtet
