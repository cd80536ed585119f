// A log under its name, opened and checked, with everything that is said about it made ready.
// Immutable, but for what is found out of it later.
#pragma once

#include <sys/types.h>

#include <ctime>
#include <filesystem>
#include <memory>
#include <string>

#include "codec/log/log_file.h"
#include "proto/manifest.h"
#include "server/store/packet_intervals.h"
#include "server/wire/document.h"

namespace qtet {

/// What tells a file from the one that had its name before.
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

struct ServedMesh {
  std::string id;  ///< the file's name without `.qtet`
  LogFile log;
  /// Agrees with the log's table: as many fields, as many components, chunks that exist.
  Manifest manifest;
  std::time_t modified;  ///< the file's, in seconds since 1970
  FileIdentity file{};
  /// Of the bytes of `log`, for the kernel to send them from.
  std::unique_ptr<Descriptor> descriptor{};
  /// Of its packets, once a view has asked for them.
  std::shared_ptr<KnownIntervals> intervals = std::make_shared<KnownIntervals>();
  /// Its part of limits::kMaxCopiedBytes; nullptr: the file is mapped.
  std::shared_ptr<void> copied{};

  /// `GET /v1/meshes/{id}`, made when it is first asked for, since compressing it takes ten times
  /// as long as opening a small log. Thread-safe, as the next one.
  [[nodiscard]] const Document& description() const;
  /// `GET /v1/logs/{sha256}/manifest`
  [[nodiscard]] const Document& manifestText() const;
  struct Texts;
  std::shared_ptr<Texts> texts = makeTexts();

  /// Length of the file's prefix that holds level `level`. REQUIRES: such a level.
  [[nodiscard]] std::uint64_t prefixBytes(std::uint32_t level) const;

 private:
  static std::shared_ptr<Texts> makeTexts();
};

/// Whoever holds one keeps the log mapped, also after the file was replaced or removed.
using MeshPointer = std::shared_ptr<const ServedMesh>;

/// A log of at most limits::kMaxCopiedLogBytes is served from a copy of its own, without a name, as
/// long as all of them together stay within limits::kMaxCopiedBytes: whatever happens to its file
/// (copied over, truncated) changes nothing of what stands under its digest. Others are mapped.
/// Opens a log as mesh `id` and checks everything that can be checked without decoding: header,
/// table, manifest, every CRC-32C. Reads the whole file. Errors: those of LogFile::open,
/// verifyChecksums and manifestOf. Without `copy` it is mapped in any case: for a look at it.
[[nodiscard]] Result<MeshPointer> openMesh(const std::filesystem::path& path, std::string id,
                                           bool copy = true);

/// The log that openMesh() has given as mesh `id` with this digest, out of the same file: neither
/// its digest nor its checksums are computed again, so this takes as long for large logs as for
/// small ones, but for those that are copied. Errors: io (the file is not `file` any more, among
/// others).
[[nodiscard]] Result<MeshPointer> reopenMesh(const std::filesystem::path& path, std::string id,
                                             const std::string& digest, const FileIdentity& file);

/// nullopt: there is no such file, or it is no regular one.
[[nodiscard]] std::optional<FileIdentity> identityOf(const std::filesystem::path& path);

}  // namespace qtet
