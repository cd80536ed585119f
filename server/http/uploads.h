// PUT and DELETE of meshes. A log is written to a hidden file beside the others, verified and
// decoded whole, and renamed to its name. So the log is there whole or not at all, whatever happens
// meanwhile (PROTOCOL.md, "Uploads").
#pragma once

#include <unistd.h>

#include <atomic>
#include <cassert>
#include <chrono>
#include <cstdint>
#include <expected>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>

#include "codec/log/log_delta.h"
#include "server/http/http_message.h"
#include "server/http/upload_limits.h"
#include "server/http/upload_parts.h"
#include "server/store/log_check.h"
#include "server/store/mesh_store.h"
#include "server/wire/upload_request.h"

namespace qtet {

class Uploads;

/// One upload under way. For one thread at a time; `uploads` must outlive it.
class Upload {
 public:
  Upload(const Upload&) = delete;
  Upload& operator=(const Upload&) = delete;
  /// Keeps the received bytes for resuming if the request named its digest; else removes them.
  ~Upload();

  /// Waits for the disk, so not for a thread that serves others. nullopt: the bytes are written.
  /// Else the answer that ends the upload: 507 (the disk is full; the received bytes are removed)
  /// or 500.
  /// So that no call takes long, a part of a delta may be left: see isBusy(). The answer to bytes
  /// that are no delta is 400.
  [[nodiscard]] std::optional<Reply> append(ByteView bytes);
  /// A part of a delta is left: append({}) goes on with it, and takes no other bytes until then.
  [[nodiscard]] bool isBusy() const { return delta_ && !delta_->needsBytes(); }
  /// 202: this part is kept, and more is missing; nullopt: all bytes are there. Or 400 (a delta
  /// that is not whole), 500.
  [[nodiscard]] std::optional<Reply> partial();
  /// After the last byte: verifies, decodes and publishes. Reads the whole file and takes as long
  /// as its check may, so not for a thread that serves others. 201 (new), 200 (replaced), or 412,
  /// 413, 422, 500, 503 (`stop` was requested, or there is no memory, among others), 507. After 413
  /// or 422 the upload cannot be resumed.
  [[nodiscard]] Reply finish(const std::stop_token& stop);

 private:
  friend class Uploads;
  /// `base` is the log that the body is a delta to, or nullptr.
  Upload(Uploads& uploads, UploadRequest request, MeshPointer base, std::filesystem::path part,
         int file)
      : uploads_(uploads),
        request_(std::move(request)),
        base_(std::move(base)),
        part_(std::move(part)),
        file_(file),
        remove_(!request_.digest) {
    assert(file >= 0 && request_.first <= request_.totalBytes);
    if (base_) delta_.emplace(base_->log.bytes(), request_.totalBytes - request_.first);
  }
  std::optional<Reply> write(ByteView bytes);
  /// After 507 what came goes: kept it would keep the disk full.
  Reply diskTrouble(const std::string& what, int number);
  /// nullopt: the log is sound, and `mesh` it; else the answer.
  std::optional<Reply> verify(const std::stop_token& stop, MeshPointer& mesh);
  /// 409 where the mesh's log is neither the one that the body was a delta to nor the new one.
  /// REQUIRES: `uploads_.publishing_` is held.
  [[nodiscard]] std::optional<Reply> baseGone(const std::string& digest) const;
  Reply publish(const std::string& digest);

  Uploads& uploads_;
  const UploadRequest request_;
  const MeshPointer base_;
  const std::filesystem::path part_;
  int file_;
  bool remove_;  // the part, at the end
  std::optional<DeltaReader> delta_{};
};

[[nodiscard]] inline ssize_t writeTo(int file, ByteView bytes) {
  return ::write(file, bytes.data(), bytes.size());
}

struct UploadOptions {
  std::uintmax_t maxBytes = limits::kMaxUploadBytes;  ///< of a log
  std::size_t deltaPiece = limits::kDeltaPiece;       ///< bytes of one call of Upload::append
  CheckLimits checkLimits{};
  LogCheck check = checkLog;
  /// write(2), or what stands for it. Waits for the disk.
  std::function<ssize_t(int file, ByteView bytes)> write = writeTo;
  PartQuota parts{};  ///< of those that are kept
};

/// Thread-safe: `mutex_` guards the parts, `publishing_` every change of a mesh. Several servers
/// may share the folder: each recognises the others' active uploads by their locks and leaves their
/// parts alone.
class Uploads {
 public:
  /// `store` must outlive it.
  Uploads(const MeshStore& store, UploadOptions options)
      : store_(store), options_(std::move(options)), parts_(store.folder(), options_.parts) {}

  /// Opens the file for the bytes, or returns the answer: 404 (no such name), 409 (the range does
  /// not begin where the upload stopped, somebody is sending the same, or the mesh's log is not the
  /// one that the body is a delta to), 412, 413, 500, 503, 507.
  [[nodiscard]] std::expected<std::unique_ptr<Upload>, Reply> begin(const UploadRequest& request);
  /// Bytes received of an interrupted upload of this log under this name; nullopt: there is none.
  /// REQUIRES: a name that a mesh may have.
  [[nodiscard]] std::optional<std::uint64_t> partialBytes(const std::string& id,
                                                          const std::string& digest) const;
  /// 204, 404 or 412.
  [[nodiscard]] Reply remove(const UploadRequest& request);
  /// Removes the parts of uploads that cannot be resumed, and of those that nobody resumed for
  /// limits::kPartialUploadTime.
  void sweep();
  /// Stops all checks: those under way and all later ones.
  void stopChecks() { ending_.request_stop(); }

  [[nodiscard]] std::size_t active() const;
  /// Bytes of uploads that are not whole, under way or kept for resuming.
  [[nodiscard]] std::uintmax_t partBytes() const;
  /// The active uploads whose logs are being decoded.
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
