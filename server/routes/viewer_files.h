// The viewer's files, read into memory once at the start. No path can reach a file that is not in
// the list.
#pragma once

#include <ctime>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>

#include "proto/bytes.h"
#include "proto/error.h"

namespace qtet {

struct ViewerFile {
  Bytes bytes;
  /// The same compressed, from NAME.gz beside it, or by ourselves; empty: it does not pay.
  Bytes gzip;
  Bytes zstd;            ///< likewise
  std::string type;      ///< media type
  std::string etag;      ///< strong, with its quotes
  std::time_t modified;  ///< seconds since 1970
  bool immutable;        ///< its name changes with its content, as names under assets/ do
};

/// Safe to read from any thread.
class ViewerFiles {
 public:
  /// No viewer at all.
  ViewerFiles() = default;
  /// Reads every regular file below `folder`. Left out: names that start with a dot, and links that
  /// lead out of the folder. NAME.gz is not a file of its own but NAME compressed, where there is a
  /// NAME.
  /// Errors: io (unreadable, or no index.html), limit-exceeded (not a viewer: too many files or
  /// bytes).
  [[nodiscard]] static Result<ViewerFiles> load(const std::filesystem::path& folder);

  /// `path` is relative, decoded, with / between its names; "" or a path that ends in / means its
  /// index.html. nullptr: no such file.
  [[nodiscard]] const ViewerFile* find(std::string_view path) const;
  [[nodiscard]] bool empty() const { return files_.empty(); }

 private:
  void attachCompressed();
  void compressText();

  std::map<std::string, ViewerFile, std::less<>> files_;
};

}  // namespace qtet
