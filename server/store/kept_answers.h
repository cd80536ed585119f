// Where the answers of jobs are kept.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "proto/error.h"
#include "server/store/level_file.h"

namespace qtet {

/// An answer that is kept: a level, or an error that the same request would meet again.
using KeptAnswer = std::optional<Result<LevelFile>>;

/// Thread-safe. Keys are LevelRequest's.
class KeptAnswers {
 public:
  KeptAnswers() = default;
  virtual ~KeptAnswers() = default;
  KeptAnswers(const KeptAnswers&) = delete;
  KeptAnswers& operator=(const KeptAnswers&) = delete;

  /// The answer if it is at hand, within microseconds: for threads that serve others.
  [[nodiscard]] virtual KeptAnswer atHand(const std::string& key) = 0;
  /// Whether find() is worth a job.
  [[nodiscard]] virtual bool has(const std::string& key) const = 0;
  /// The answer, at hand or not. May read it whole from the disk.
  [[nodiscard]] virtual KeptAnswer find(const std::string& key) = 0;
  /// Takes the answer that a job has made, and returns it from where it is kept, if it is.
  [[nodiscard]] virtual Result<LevelFile> put(const std::string& key, Result<LevelFile> made) = 0;
  /// Everything that is kept.
  [[nodiscard]] virtual std::uintmax_t bytes() const = 0;
};

}  // namespace qtet
