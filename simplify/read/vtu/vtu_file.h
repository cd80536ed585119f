// A mesh file that is read by ranges of bytes.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include "proto/error.h"
#include "simplify/read/options/read_options.h"
#include "simplify/read/process/reading_time.h"

namespace qtet {

/// An open file. Only the owner closes it; reading moves no place, so several threads may read.
class VtuFile {
 public:
  /// `patience` and the size say how long it may be read from now on (ReadingTime). Errors: io.
  [[nodiscard]] static Result<VtuFile> open(const std::filesystem::path& path,
                                            std::chrono::seconds patience = kReadPatience);
  VtuFile(VtuFile&& other) noexcept;
  VtuFile(const VtuFile&) = delete;
  VtuFile& operator=(const VtuFile&) = delete;
  VtuFile& operator=(VtuFile&&) = delete;
  ~VtuFile();

  /// Fills `into` from byte `at` on. Errors: truncated (the file ends before), io, bad-input
  /// (no time is left).
  [[nodiscard]] Status read(std::uint64_t at, std::span<std::byte> into) const;
  [[nodiscard]] std::uint64_t size() const { return size_; }
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

  /// "FILE: WHAT", at a byte of the file.
  [[nodiscard]] std::unexpected<Error> bad(const std::string& what,
                                           std::uint64_t at = Error::kNoOffset) const;

 private:
  VtuFile(int descriptor, std::uint64_t size, std::filesystem::path path,
          std::chrono::seconds patience)
      : descriptor_(descriptor), size_(size), path_(std::move(path)), time_(patience, size) {}

  int descriptor_;
  std::uint64_t size_;
  std::filesystem::path path_;
  ReadingTime time_;
};

}  // namespace qtet
