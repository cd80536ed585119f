#include "server/http/uploads.h"

#include <fcntl.h>
#include <spdlog/spdlog.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cassert>
#include <cerrno>
#include <cstring>
#include <exception>
#include <new>

#include "codec/files/is_at.h"
#include "proto/json_reader.h"
#include "proto/log_digest.h"
#include "server/http/http_resource.h"
#include "server/http/part_lock.h"
#include "server/http/publishing.h"
#include "server/http/upload_limits.h"
#include "server/wire/request_target.h"

namespace qtet {
namespace {

namespace fs = std::filesystem;

/// The folder of meshes, or its place, does not let this process change it.
bool isForbidden(int number) {
  return number == EACCES || number == EPERM || number == EROFS || number == ENOENT ||
         number == ENOTDIR;
}

Reply troubleOf(const std::string& what, int number) {
  if (number == ENOSPC || number == EDQUOT)
    return problem(507, "insufficient-storage", "the server's disk is full; nothing was changed");
  spdlog::error("an upload: {}: {}", what, std::strerror(number));
  if (isForbidden(number))
    return busyReply(
        "the server cannot write into its folder of meshes, and nothing was changed; ask its "
        "operator to make the folder writable (the server's log has the reason), then try again");
  return problem(500, "internal", what + ": " + std::strerror(number));
}

constexpr std::string_view kSomebodySends = "somebody is sending this log at the moment";

/// 409 where a folder has the mesh's name: a log cannot take its place.
std::optional<Reply> folderInTheWay(const fs::path& target) {
  std::error_code ec;
  if (!fs::is_directory(fs::symlink_status(target, ec))) return std::nullopt;
  return problem(409, "upload-conflict",
                 "there is a folder of the name " + target.filename().string() +
                     "; send the log by another name, or ask the server's operator to remove it");
}

/// nullopt: the log is sound.
std::optional<Reply> replyTo(const CheckVerdict& verdict) {
  switch (verdict.end) {
    case CheckVerdict::End::kSound: return std::nullopt;
    case CheckVerdict::End::kTooLarge: return problem(413, "content-too-large", verdict.reason);
    case CheckVerdict::End::kUnsound: return problem(422, "bad-log", verdict.reason);
    case CheckVerdict::End::kBusy: return busyReply(verdict.reason);
    case CheckVerdict::End::kFailed: break;
  }
  return problem(500, "internal", verdict.reason);
}

class Counted {
 public:
  explicit Counted(std::atomic<std::size_t>& count) : count_(count) { ++count_; }
  Counted(const Counted&) = delete;
  Counted& operator=(const Counted&) = delete;
  ~Counted() { --count_; }

 private:
  std::atomic<std::size_t>& count_;
};

}  // namespace

Upload::~Upload() {
  // before the lock goes: behind it the name may be another server's
  if (remove_) ::unlink(part_.c_str());
  ::close(file_);
  const std::scoped_lock lock(uploads_.mutex_);
  uploads_.parts_.end(part_);
}

Reply Upload::diskTrouble(const std::string& what, int number) {
  Reply out = troubleOf(what, number);
  if (out.status == 507) remove_ = true;
  return out;
}

std::optional<Reply> Upload::append(ByteView bytes) {
  assert(bytes.empty() || !isBusy());
  if (!delta_) return write(bytes);
  if (!bytes.empty()) delta_->feed(bytes);
  const std::size_t most = uploads_.options_.deltaPiece;
  for (std::size_t done = 0; isBusy() && done < most;) {
    const Result<ByteView> piece = delta_->next(most - done);
    if (!piece) return problem(400, "bad-request", piece.error().message);
    if (std::optional<Reply> trouble = write(*piece)) return trouble;
    done += piece->size();
  }
  return std::nullopt;
}

std::optional<Reply> Upload::write(ByteView bytes) {
  while (!bytes.empty()) {
    const ssize_t n = uploads_.options_.write(file_, bytes);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return diskTrouble("the upload cannot be written", errno);
    bytes = bytes.subspan(static_cast<std::size_t>(n));
  }
  return std::nullopt;
}

std::optional<Reply> Upload::partial() {
  if (delta_ && !delta_->isWhole())
    return problem(400, "bad-request", "the delta ends within an instruction");
  struct stat info{};
  if (::fstat(file_, &info) != 0) return diskTrouble("the upload cannot be read", errno);
  if (static_cast<std::uint64_t>(info.st_size) >= request_.totalBytes) return std::nullopt;
  return momentaryReply(202, "application/json",
                        dumpJson({{"digest", *request_.digest}, {"bytes", info.st_size}}));
}

std::optional<Reply> Upload::verify(const std::stop_token& stop, MeshPointer& mesh) {
  if (stop.stop_requested()) return busyReply("the check was broken off");
  if (::fsync(file_) != 0) return diskTrouble("the upload cannot be kept", errno);
  Result<MeshPointer> opened = openMesh(part_, request_.id);
  // where it lies is nobody's business
  if (!opened && opened.error().message.starts_with(part_.string() + ": "))
    opened.error().message.erase(0, part_.string().size() + 2);
  if (!opened && opened.error().code == ErrorCode::kIo)
    return busyReply("the log is here but cannot be verified now: " + opened.error().text());
  if (!opened) return problem(422, "bad-log", "this is no sound log: " + opened.error().text());
  mesh = std::move(*opened);
  if (request_.digest && mesh->log.digest() != *request_.digest)
    return problem(
        422, "bad-log",
        "the log has the digest " + mesh->log.digest() + ", not the one that the request names");
  const Counted counted(uploads_.checking_);
  return replyTo(uploads_.options_.check(*mesh, uploads_.options_.checkLimits, stop));
}

Reply Upload::finish(const std::stop_token& stop) {
  std::stop_source either;
  const auto end = [&either] { either.request_stop(); };
  const std::stop_callback whenGone(stop, end), whenEnding(uploads_.ending_.get_token(), end);
  try {
    MeshPointer mesh;
    std::optional<Reply> refusal = verify(either.get_token(), mesh);
    if (!refusal) return publish(mesh->log.digest());
    // going on with it would not make it better
    if (refusal->status == 413 || refusal->status == 422) remove_ = true;
    return std::move(*refusal);
  } catch (const std::bad_alloc&) {  // it ends one upload, not the server
    return busyReply("there is not enough memory for this log now; try again");
  } catch (const std::exception& error) {
    spdlog::error("an upload ended by an exception: {}", error.what());
    return problem(500, "internal", "the log could not be checked or published");
  }
}

std::optional<Reply> Upload::baseGone(const std::string& digest) const {
  if (!request_.from) return std::nullopt;
  const MeshPointer mesh = uploads_.store_.find(request_.id);
  if (mesh && (mesh->log.digest() == *request_.from || mesh->log.digest() == digest))
    return std::nullopt;
  return problem(409, "upload-conflict",
                 "the mesh's log was replaced or removed while this delta to it arrived; nothing "
                 "was changed; look at the present log, then send yours again");
}

Reply Upload::publish(const std::string& digest) {
  const std::scoped_lock lock(uploads_.publishing_);
  std::optional<FolderLock> folder(uploads_.store_.folder());
  if (request_.ifMatch || request_.ifNoneMatch || request_.from)
    (void)uploads_.store_.rescan(request_.id);  // what another server has published counts
  if (std::optional<Reply> refusal = uploads_.precondition(request_)) return std::move(*refusal);
  if (std::optional<Reply> refusal = baseGone(digest)) return std::move(*refusal);
  // A file that is no sound log stands for no mesh.
  const bool unsound = uploads_.store_.catalogue()->refused.contains(request_.id);
  const bool replaced = uploads_.store_.find(request_.id) != nullptr;
  const fs::path target = *pathOfMesh(uploads_.store_.folder(), request_.id);
  const int failed = publishAs(part_, target, request_.ifNoneMatch && !replaced && !unsound);
  if (failed != 0)
    if (std::optional<Reply> refusal = folderInTheWay(target)) return std::move(*refusal);
  if (failed == EEXIST)
    return problem(412, "precondition-failed", "there is a file of that name by now");
  if (failed != 0) return diskTrouble("the upload cannot be published", failed);
  folder.reset();
  remove_ = false;
  if (const Status synced = syncFolder(uploads_.store_.folder()); !synced)
    spdlog::warn("after an upload: {}", synced.error().message);
  ++uploads_.published_;
  const Result<FolderChange> change = uploads_.store_.rescan(request_.id);
  const MeshPointer mesh = uploads_.store_.find(request_.id);
  if (!change || !mesh || mesh->log.digest() != digest)
    return problem(500, "internal", "the log was published but cannot be served now");
  spdlog::info("{}: uploaded, {} bytes", mesh->id, mesh->log.bytes().size());
  Reply out = beginReply(
      replaced ? 200 : 201,
      {{mesh->description().etag(), mesh->modified}, "application/json", "no-store", {}});
  out.headers.add("Location", "/v1/meshes/" + percentEncode(mesh->id));
  out.body = std::string(mesh->description().text());
  return out;
}

std::optional<Reply> Uploads::precondition(const UploadRequest& request) const {
  const MeshPointer mesh = store_.find(request.id);
  RequestView view{.method = "PUT", .target = ""};
  if (request.ifMatch) view.ifMatch = *request.ifMatch;
  if (request.ifNoneMatch) view.ifNoneMatch = *request.ifNoneMatch;
  // A mesh that does not exist has no tag at all: If-Match fails and If-None-Match succeeds.
  const bool fails =
      mesh
          ? evaluateConditions(view, {mesh->description().etag(), mesh->modified}) != Verdict::kSend
          : request.ifMatch.has_value();
  if (!fails) return std::nullopt;
  return problem(
      412, "precondition-failed",
      mesh ? "the mesh's ETag is " + mesh->description().etag() : "there is no mesh of that name");
}

std::expected<std::unique_ptr<Upload>, Reply> Uploads::begin(const UploadRequest& request) {
  const auto refuse = [](Reply reply) { return std::unexpected(std::move(reply)); };
  if (request.totalBytes > options_.maxBytes)
    return refuse(
        problem(413, "content-too-large",
                "a log has at most " + std::to_string(options_.maxBytes) + " bytes here"));
  if (std::optional<Reply> refusal = precondition(request)) return refuse(std::move(*refusal));
  if (std::optional<Reply> refusal = folderInTheWay(*pathOfMesh(store_.folder(), request.id)))
    return refuse(std::move(*refusal));

  // The name's log alone: a token for this mesh then reads no other one.
  MeshPointer base = request.from ? store_.find(request.id) : nullptr;
  if (request.from && (!base || base->log.digest() != *request.from))
    return refuse(problem(409, "upload-conflict",
                          "the mesh's log is not the one that this is a delta to; send it whole"));

  const std::scoped_lock lock(mutex_);
  const fs::path part =
      request.digest ? parts_.resumable(request.id, *request.digest) : parts_.nameless();
  if (parts_.underWay(part)) return refuse(problem(409, "upload-conflict", kSomebodySends));
  if (parts_.countUnderWay() >= limits::kMaxUploads)
    return refuse(noPlaceReply("too many uploads; try again"));
  if (parts_.countUnderWay(request.token) >= limits::kMaxUploadsOfToken)
    return refuse(noPlaceReply("too many uploads of this token; try again"));
  parts_.removeOld(limits::kPartialUploadTime);
  const int flags = O_WRONLY | O_APPEND | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK |
                    (request.first == 0 ? O_CREAT : 0);
  const int file = ::open(part.c_str(), flags, 0644);
  if (file < 0 && (request.first == 0 || errno != ENOENT))
    return refuse(troubleOf("the upload cannot be written", errno));
  const auto refuseOpened = [&](Reply reply) {
    if (file >= 0) ::close(file);
    return refuse(std::move(reply));
  };
  struct stat info{};
  if (file >= 0 && (isLocked(file) || !isAt(part, file)))
    return refuseOpened(problem(409, "upload-conflict", kSomebodySends));
  if (file >= 0 && request.first == 0 && ::ftruncate(file, 0) != 0)
    return refuseOpened(troubleOf("the upload cannot be written", errno));
  if (file < 0 || ::fstat(file, &info) != 0 ||
      static_cast<std::uint64_t>(info.st_size) != request.first)
    return refuseOpened(problem(
        409, "upload-conflict",
        "there are " + std::to_string(info.st_size) + " bytes of this log; go on from there"));
  if (std::optional<Reply> refusal = parts_.begin(request, part)) {
    if (request.first == 0) ::unlink(part.c_str());  // it was empty
    return refuseOpened(std::move(*refusal));
  }
  return std::unique_ptr<Upload>(new Upload(*this, request, std::move(base), part, file));
}

std::optional<std::uint64_t> Uploads::partialBytes(const std::string& id,
                                                   const std::string& digest) const {
  assert(pathOfMesh("", id));
  if (!isLogDigest(digest)) return std::nullopt;
  const std::scoped_lock lock(mutex_);
  const auto file = identityOf(parts_.resumable(id, digest));
  return file ? std::optional(static_cast<std::uint64_t>(file->bytes)) : std::nullopt;
}

Reply Uploads::remove(const UploadRequest& request) {
  const std::scoped_lock lock(publishing_);
  const FolderLock folder(store_.folder());
  if (request.ifMatch || request.ifNoneMatch) (void)store_.rescan(request.id);
  if (std::optional<Reply> refusal = precondition(request)) return std::move(*refusal);
  if (!store_.find(request.id))
    return problem(404, "not-found", "there is no mesh of that name; the list is at /v1/meshes");
  if (::unlink(pathOfMesh(store_.folder(), request.id)->c_str()) != 0 && errno != ENOENT)
    return troubleOf("the mesh cannot be removed", errno);
  if (const Result<FolderChange> change = store_.rescan(); !change)
    return problem(500, "internal", change.error().message);
  spdlog::info("{}: removed by request", request.id);
  Reply out;
  out.status = 204;
  addCommonHeaders(out.headers);
  return out;
}

void Uploads::sweep() {
  const std::scoped_lock lock(mutex_);
  parts_.removeOld(-limits::kPartialUploadTime);  // of any age, and whatever the clock was set to
}

std::uintmax_t Uploads::partBytes() const {
  const std::scoped_lock lock(mutex_);
  return parts_.bytes();
}

std::size_t Uploads::active() const {
  const std::scoped_lock lock(mutex_);
  return parts_.countUnderWay();
}

}  // namespace qtet
