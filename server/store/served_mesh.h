// A log under its name, opened and checked, with everything that is said about it made ready.
// Immutable, but for what is found out of it later.
#pragma once

#include <sys/types.h>

#include <ctime>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "codec/refine/log_file.h"
#include "proto/field_keys.h"
#include "proto/manifest.h"
#include "server/wire/document.h"

namespace qtet {

/// Distinguishes a file from the one that had its name before.
struct FileIdentity {
  dev_t device = 0;
  ino_t inode = 0;
  off_t bytes = 0;
  timespec modified{};

  bool operator==(const FileIdentity& other) const {
    return device == other.device && inode == other.inode && bytes == other.bytes &&
           modified.tv_sec == other.modified.tv_sec && modified.tv_nsec == other.modified.tv_nsec;
  }
};

/// A file that is open as long as the object lives.
struct Descriptor {
  explicit Descriptor(int opened) : number(opened) {}
  ~Descriptor();
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  const int number;  ///< -1: it could not be opened
};

/// A log that is served. Immutable but for its texts and keys, each of which is made once.
struct ServedMesh {
  std::string id;  ///< the file's name without `.qtet`
  LogFile log;
  /// Agrees with the log's table: as many fields, as many components, chunks that exist.
  Manifest manifest;
  std::time_t modified;  ///< the file's, in seconds since 1970
  FileIdentity file{};
  /// The file of `log`'s bytes, from which the kernel sends them.
  std::unique_ptr<Descriptor> descriptor{};
  /// Its part of limits::kMaxCopiedBytes; nullptr: the file is mapped.
  std::shared_ptr<void> copied{};

  /// `GET /v1/meshes/{id}`, and `GET /v1/logs/{sha256}/manifest`
  enum class Text : std::uint8_t { kDescription, kManifest };
  /// Made when it is first asked for, since compressing it takes ten times as long as opening a
  /// small log. Thread-safe.
  [[nodiscard]] const Document& text(Text which) const;
  /// It is made already, or making it takes no longer than a turn may (limits::kLongTurn).
  [[nodiscard]] bool isQuick(Text which) const;
  [[nodiscard]] const Document& description() const { return text(Text::kDescription); }
  /// The keys of the manifest's fields and series. Made when it is first asked for;
  /// thread-safe, as the texts.
  [[nodiscard]] const FieldKeys& keys() const;
  struct Texts;
  std::shared_ptr<Texts> texts = makeTexts();

  /// Length of the file's prefix that holds level `level`. REQUIRES: such a level.
  [[nodiscard]] std::uint64_t prefixBytes(std::uint32_t level) const;

 private:
  static std::shared_ptr<Texts> makeTexts();
};

/// Each of these pointers keeps the log mapped, even after the file was replaced or removed.
using MeshPointer = std::shared_ptr<const ServedMesh>;

/// Opens a log as mesh `id` and checks everything that can be checked without decoding: header,
/// table, manifest, every CRC-32C. Reads the whole file. A log of at most
/// limits::kMaxCopiedLogBytes is served from a nameless copy, while all copies together stay within
/// limits::kMaxCopiedBytes. If its file is overwritten or truncated, the bytes under its digest do
/// not change. Other logs are mapped. Errors: those of LogFile::open, verifyChecksums and
/// manifestOf. Without `copy` it is always mapped, just for a look at it.
[[nodiscard]] Result<MeshPointer> openMesh(const std::filesystem::path& path, std::string id,
                                           bool copy = true);

/// Opens again, from the same file, a log that openMesh() has opened as mesh `id` with this digest.
/// It computes neither digest nor checksums, so a large log takes no longer than a small one,
/// unless it is copied. Errors: io (the file is not `file` any more, among others).
[[nodiscard]] Result<MeshPointer> reopenMesh(const std::filesystem::path& path, std::string id,
                                             const std::string& digest, const FileIdentity& file);

/// Bytes of all copies that this process holds, at most limits::kMaxCopiedBytes.
[[nodiscard]] std::uintmax_t bytesOfCopies();

/// nullopt: there is no such file, or it is no regular one.
[[nodiscard]] std::optional<FileIdentity> identityOf(const std::filesystem::path& path);

}  // namespace qtet
