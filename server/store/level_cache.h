// Finished levels on disk, found again by their keys; the least recently used go when there are too
// many bytes or too many levels.
#pragma once

#include <cstdint>
#include <filesystem>
#include <list>
#include <map>
#include <mutex>
#include <optional>
#include <string>

#include "proto/error.h"
#include "server/store/free_disk.h"
#include "server/store/kept_answers.h"
#include "server/store/served_mesh.h"
#include "server/store/store_limits.h"

namespace qtet {

/// Thread-safe: `mutex_` guards the entries; files are written and read without it. The folder is
/// this object's alone: nobody else may write into its files.
class LevelCache final : public KeptAnswers {
 public:
  /// Makes the folder if it does not exist. Takes over the levels of an earlier run, and removes
  /// unfinished files of one that was killed. Errors: io.
  [[nodiscard]] static Result<std::unique_ptr<LevelCache>> open(
      const std::filesystem::path& folder, std::uintmax_t maxBytes,
      std::uintmax_t reserve = limits::kDiskReserve, FreeDiskBytes freeBytes = freeDiskBytes,
      std::size_t maxLevels = limits::kMaxCachedLevels);

  /// One of the levels used last, whose file was compared with its checksum and has not changed
  /// since. `key` is hexadecimal, as in the next ones.
  [[nodiscard]] KeptAnswer atHand(const std::string& key) override;
  [[nodiscard]] bool has(const std::string& key) const override;
  /// nullopt: there is none, or its file is not what was written (its length or its CRC-32C
  /// differs), which then goes. Reads the whole level, unless it is at hand.
  [[nodiscard]] KeptAnswer find(const std::string& key) override;
  /// Keeps the level on disk and returns it from there. Returns it as it is in three cases: the
  /// disk refuses, it alone exceeds the cache's size, or the disk's reserve would be touched. Keeps
  /// no error.
  [[nodiscard]] Result<LevelFile> put(const std::string& key, Result<LevelFile> made) override;
  [[nodiscard]] std::uintmax_t bytes() const override;

 private:
  struct Entry {
    std::string key;
    std::uintmax_t bytes;
    /// At hand, and the file as it was then.
    std::optional<LevelFile> open{};
    FileIdentity file{};
  };
  LevelCache(std::filesystem::path folder, std::uintmax_t maxBytes, std::uintmax_t reserve,
             FreeDiskBytes freeBytes, std::size_t maxLevels)
      : folder_(std::move(folder)),
        maxBytes_(maxBytes),
        reserve_(reserve),
        maxLevels_(maxLevels),
        freeBytes_(std::move(freeBytes)) {}
  [[nodiscard]] std::filesystem::path pathOf(const std::string& key) const;
  void add(const std::string& key, std::uintmax_t bytes);
  void forget(const std::string& key);
  /// Removes the entry with its file. REQUIRES: mutex_ is held, as for the next one.
  void discard(const std::string& key);
  void hold(Entry& entry, const LevelFile& level, const FileIdentity& file);

  const std::filesystem::path folder_;
  const std::uintmax_t maxBytes_, reserve_;
  const std::size_t maxLevels_;
  const FreeDiskBytes freeBytes_;
  mutable std::mutex mutex_;
  std::uintmax_t bytes_ = 0;
  std::list<Entry> entries_;  // the most recently used first
  std::size_t open_ = 0;      // entries at hand
  std::map<std::string, std::list<Entry>::iterator> byKey_;
};

}  // namespace qtet
