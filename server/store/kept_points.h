// Values of series at points, in memory: small, many, and asked for again while somebody looks at a
// plot.
#pragma once

#include <cstdint>
#include <list>
#include <map>
#include <mutex>

#include "server/store/kept_answers.h"
#include "server/store/store_limits.h"

namespace qtet {

/// The least recently used go when there are too many, or too many bytes. Thread-safe: `mutex_`
/// guards it.
class KeptPoints final : public KeptAnswers {
 public:
  explicit KeptPoints(std::size_t most = limits::kMaxKeptPoints,
                      std::uint64_t maxBytes = limits::kMaxKeptPointBytes)
      : most_(most), maxBytes_(maxBytes) {}

  [[nodiscard]] KeptAnswer atHand(const std::string& key) override;
  [[nodiscard]] bool has(const std::string& key) const override;
  [[nodiscard]] KeptAnswer find(const std::string& key) override { return atHand(key); }
  /// Keeps values, and that a point is outside (not-found). Other errors may not come again.
  [[nodiscard]] Result<LevelFile> put(const std::string& key, Result<LevelFile> made) override;
  [[nodiscard]] std::uintmax_t bytes() const override;

 private:
  struct Entry {
    std::string key;
    Result<LevelFile> answer;
    std::uint64_t bytes;
  };
  void forgetOldest();

  const std::size_t most_;
  const std::uint64_t maxBytes_;
  mutable std::mutex mutex_;
  std::uint64_t bytes_ = 0;
  std::list<Entry> entries_;  // the most recently used first
  std::map<std::string, std::list<Entry>::iterator, std::less<>> byKey_;
};

}  // namespace qtet
