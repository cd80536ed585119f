// PUT and DELETE of meshes: a log comes into a hidden file beside the others, is verified and
// decoded whole, and gets its name by a rename; so it is there as a whole or not at all, whatever
// happens on the way (PROTOCOL.md, "Uploads").
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <expected>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>

#include "server/http/http_message.h"
#include "server/http/log_check.h"
#include "server/http/upload_limits.h"
#include "server/http/upload_parts.h"
#include "server/store/mesh_store.h"
#include "server/wire/upload_request.h"

namespace qtet {

class Uploads;

/// One upload under way. Not thread-safe; `uploads` must outlive it.
class Upload {
 public:
  Upload(const Upload&) = delete;
  Upload& operator=(const Upload&) = delete;
  /// What came stays for going on with it if the request named its digest; else it goes.
  ~Upload();

  /// nullopt: the bytes are written; else the answer that ends the upload: 507 (the disk is full;
  /// what came goes) or 500.
  [[nodiscard]] std::optional<Reply> append(ByteView bytes);
  /// 202: this part is kept, and more is missing; nullopt: all bytes are there. Or 500.
  [[nodiscard]] std::optional<Reply> partial();
  /// After the last byte: verifies, decodes and publishes. Reads the whole file and takes as long
  /// as its check may, so not for a thread that serves others. 201 (new), 200 (replaced), or 412,
  /// 413, 422, 500, 503 (`stop` was requested, or there is no memory, among others), 507. What is
  /// refused by 413 or 422 cannot be gone on with.
  [[nodiscard]] Reply finish(const std::stop_token& stop);

 private:
  friend class Uploads;
  Upload(Uploads& uploads, UploadRequest request, std::filesystem::path part, int file)
      : uploads_(uploads),
        request_(std::move(request)),
        part_(std::move(part)),
        file_(file),
        remove_(!request_.digest) {}
  /// After 507 what came goes: kept it would keep the disk full.
  Reply diskTrouble(const std::string& what, int number);
  /// nullopt: the log is sound, and `mesh` it; else the answer.
  std::optional<Reply> verify(const std::stop_token& stop, MeshPointer& mesh);
  Reply publish(const std::string& digest);

  Uploads& uploads_;
  const UploadRequest request_;
  const std::filesystem::path part_;
  int file_;
  bool remove_;  // the part, at the end
};

struct UploadOptions {
  std::uintmax_t mostBytes = limits::kMaxUploadBytes;  ///< of a log
  CheckLimits checkLimits{};
  LogCheck check = checkLog;
  PartQuota parts{};  ///< of those that are kept
};

/// Thread-safe. Several servers may share the folder: each lets the parts of the others' uploads
/// under way alone, by their locks.
class Uploads {
 public:
  /// `store` must outlive it.
  Uploads(const MeshStore& store, UploadOptions options)
      : store_(store), options_(std::move(options)), parts_(store.folder(), options_.parts) {}

  /// Opens the place where the bytes go; or the answer: 404 (no such name), 409 (the range does not
  /// go on where it stopped, or somebody is sending the same), 412, 413, 500, 503, 507.
  [[nodiscard]] std::expected<std::unique_ptr<Upload>, Reply> begin(const UploadRequest& request);
  /// Bytes that are there of an upload of this log under this name that broke off; nullopt: none.
  /// REQUIRES: a name that a mesh may have.
  [[nodiscard]] std::optional<std::uint64_t> partialBytes(const std::string& id,
                                                          const std::string& digest) const;
  /// 204, 404 or 412.
  [[nodiscard]] Reply remove(const UploadRequest& request);
  /// Removes what uploads left behind: those that cannot be gone on with, and those that nobody
  /// went on with for limits::kPartialUploadTime.
  void sweep() const;
  /// From now on checks break off, those under way as well.
  void stopChecks() { ending_.request_stop(); }

  [[nodiscard]] std::size_t active() const;
  /// Of them, those whose logs are being decoded.
  [[nodiscard]] std::size_t checking() const { return checking_; }
  [[nodiscard]] std::uint64_t published() const { return published_; }

 private:
  friend class Upload;
  /// nullopt, or the 412 that If-Match and If-None-Match demand as things stand.
  [[nodiscard]] std::optional<Reply> precondition(const UploadRequest& request) const;
  const MeshStore& store_;
  const UploadOptions options_;
  std::stop_source ending_;
  std::mutex publishing_;  // between the check of a condition and the rename nothing changes
  mutable std::mutex mutex_;
  UploadParts parts_;  // guarded by `mutex_`
  std::atomic<std::size_t> checking_ = 0;
  std::atomic<std::uint64_t> published_ = 0;
};

}  // namespace qtet
