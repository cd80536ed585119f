// The viewer's files, read into memory once at the start. No path can reach a file that is not in
// the list.
#pragma once

#include <atomic>
#include <ctime>
#include <filesystem>
#include <map>
#include <memory>
#include <stop_token>
#include <string>
#include <string_view>

#include "proto/bytes.h"
#include "proto/error.h"
#include "server/wire/content_coding.h"

namespace qtet {

struct Variants;  // server/http/http_resource.h

/// A file's bytes compressed; an empty one is not there.
struct CodedFile {
  Bytes gzip{}, zstd{};
};

struct ViewerFile {
  Bytes bytes;
  CodedFile built;       ///< from NAME.gz and NAME.zst beside it
  CodedFile late;        ///< what these lack and what pays; written by compressRest alone
  std::string type;      ///< media type
  std::string etag;      ///< strong, with its quotes
  std::time_t modified;  ///< seconds since 1970
  bool immutable;        ///< its name changes with its content, as names under assets/ do
};

/// Safe to read from any thread: immutable but for what compressRest() adds, which readers see once
/// `restIsThere_` is set.
class ViewerFiles {
 public:
  /// No viewer at all.
  ViewerFiles() = default;
  /// Reads every regular file below `folder`. Left out: names that start with a dot, and links that
  /// lead out of the folder. NAME.gz and NAME.zst are no files of their own but NAME compressed,
  /// where there is a NAME. Both are unpacked and compared with it. One that gives other bytes, as
  /// of an older build, is left out with a line in the log.
  /// Errors: io (unreadable, or no index.html), limit-exceeded (not a viewer: too many files or
  /// bytes).
  [[nodiscard]] static Result<ViewerFiles> load(const std::filesystem::path& folder);

  /// `path` is relative, decoded, with / between its names; "" or a path that ends in / means its
  /// index.html. nullptr: no such file.
  [[nodiscard]] const ViewerFile* find(std::string_view path) const;
  [[nodiscard]] bool empty() const { return files_.empty(); }
  /// The bytes of a file of `find` in the codings that there are by now.
  [[nodiscard]] Variants variantsOf(const ViewerFile& file) const;
  /// Compresses the texts that came without: 0.2 s for the built viewer, so for a thread beside
  /// those that serve. Call it once.
  void compressRest(const std::stop_token& stop);

 private:
  void attach(std::string_view suffix, ContentCoding coding, Bytes CodedFile::* form);

  std::map<std::string, ViewerFile, std::less<>> files_;
  /// Every `late` is written.
  std::unique_ptr<std::atomic<bool>> restIsThere_ = std::make_unique<std::atomic<bool>>(false);
};

}  // namespace qtet
