// Logs whose table, manifest and checksums are right and whose blocks are noise: enough for a
// server, which never decodes one to send it.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "codec/log/log_index.h"
#include "proto/bytes.h"

namespace qtet::test {

struct SyntheticLog {
  std::uint32_t chunks = 12;
  std::vector<std::string> fields = {"density", "velocity"};  ///< the second has three components
  /// Bytes; some blocks of values are empty, none of structure.
  std::uint32_t largestBlock = 5000;
  std::uint32_t seed = 1;
  /// Levels have errors, halved from each to the next; the last level's are 0.
  bool errors = false;
};

/// The whole file. Level k ends in chunk k.
[[nodiscard]] Bytes makeLog(const SyntheticLog& options);
/// Its front alone, for tests of code that only looks at the table.
[[nodiscard]] LogIndex makeIndex(const SyntheticLog& options);

/// A folder that goes with the object.
class TempFolder {
 public:
  TempFolder();
  ~TempFolder();
  TempFolder(const TempFolder&) = delete;
  TempFolder& operator=(const TempFolder&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  /// Writes a file, with the folders above it.
  void write(const std::string& name, ByteView bytes) const;
  void write(const std::string& name, std::string_view text) const;

 private:
  std::filesystem::path path_;
};

}  // namespace qtet::test
