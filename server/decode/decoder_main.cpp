#include "server/decode/decoder_main.h"

#include <malloc.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <condition_variable>
#include <csignal>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>
#include <utility>

#include "codec/log/log_manifest.h"
#include "server/decode/channel.h"
#include "server/decode/confinement.h"
#include "server/decode/decode_task.h"
#include "server/store/bus_guard.h"
#include "server/store/level_maker.h"
#include "server/store/series_maker.h"

namespace qtet {
namespace {

/// After so long without a task the memory for the next one goes back to the system.
constexpr std::chrono::seconds kKeptTime{30};

struct Work {
  DecodeTask task{};
  std::vector<std::unique_ptr<Descriptor>> files{};
  std::stop_token stop{};
};

/// Receives tasks on a thread of its own, so that a stop reaches the one under way.
class Inbox {
 public:
  explicit Inbox(const Channel& channel) : reader_([this, &channel] { readOn(channel); }) {}
  /// Waits; nullopt: nothing came for `most`.
  std::optional<Work> next(std::chrono::seconds most) {
    std::unique_lock lock(mutex_);
    arrived_.wait_for(lock, most, [this] { return waiting_.has_value(); });
    return std::exchange(waiting_, std::nullopt);
  }

 private:
  void readOn(const Channel& channel) {
    std::stop_source stop;
    for (;;) {
      Result<DecodeMessage> message = channel.receive();
      if (!message) ::_exit(0);  // the server has gone
      Result<DecodeTask> task = taskOf(message->bytes);
      if (!task) ::_exit(1);
      if (std::holds_alternative<StopTask>(*task)) {
        stop.request_stop();
        continue;
      }
      stop = std::stop_source();
      const std::scoped_lock lock(mutex_);
      waiting_ = {std::move(*task), std::move(message->files), stop.get_token()};
      arrived_.notify_one();
    }
  }

  std::mutex mutex_;
  std::condition_variable arrived_;
  std::optional<Work> waiting_;
  std::thread reader_;
};

/// The server has computed the digest.
std::string noDigest(ByteView) { return {}; }

Result<MeshPointer> meshOf(const Descriptor& file) {
  Result<LogFile> log = LogFile::map(file.number, "the log", noDigest);
  if (!log) return std::unexpected(log.error());
  Result<Manifest> manifest = manifestOf(log->index());
  if (!manifest) return std::unexpected(manifest.error());
  return std::make_shared<const ServedMesh>(
      ServedMesh{"", std::move(*log), std::move(*manifest), 0});
}

Status writeAll(int file, ByteView bytes) {
  while (!bytes.empty()) {
    const ssize_t count = ::write(file, bytes.data(), bytes.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0)
      return fail(ErrorCode::kIo, "there is no room for this level; ask for a coarser one");
    bytes = bytes.subspan(static_cast<std::size_t>(count));
  }
  return {};
}

class Tasks {
 public:
  DecodeAnswer operator()(Work work) {
    if (auto* level = std::get_if<LevelTask>(&work.task))
      return LevelEnd{write(std::move(*level), work)};
    forget();
    const Result<MeshPointer> mesh = meshOf(*work.files.front());
    if (!mesh) return CheckVerdict{CheckVerdict::End::kUnsound, mesh.error().text()};
    return checkLog(**mesh, std::get<CheckTask>(work.task).limits, work.stop);
  }
  void forget() {
    series_.forget();
    mesh_ = nullptr;
    digest_.clear();
    ::malloc_trim(0);
  }

 private:
  Status write(LevelTask task, const Work& work) {
    if (task.digest != digest_) {
      series_.forget();
      mesh_ = nullptr;
      const Result<MeshPointer> opened = meshOf(*work.files.front());
      if (!opened) return std::unexpected(opened.error());
      mesh_ = *opened, digest_ = task.digest;
    }
    if (!task.request.point) series_.forget();  // its memory is the level's now
    task.request.mesh = mesh_;
    const int file = work.files.back()->number;
    return writeLevel(
        task.request, [file](ByteView bytes) { return writeAll(file, bytes); }, work.stop, series_);
  }

  std::string digest_;
  MeshPointer mesh_;  // of the last level
  SeriesMaker series_;
};

}  // namespace

void runDecoder() {
  // A file that grows too large is an error of write(), and whoever stops the server ends this
  // process by closing the channel.
  for (const int number : {SIGXFSZ, SIGINT, SIGHUP, SIGUSR1, SIGTERM}) std::signal(number, SIG_IGN);
  guardAgainstBusErrors();
  const Channel channel(std::make_unique<Descriptor>(kDecoderChannel));
  Inbox inbox(channel);
  Tasks tasks;
  const auto answer = [&channel](const DecodeAnswer& given) {
    if (!channel.send(messageOf(given))) ::_exit(0);
  };
  answer(DecoderReady{confine()});
  for (;;) {
    std::optional<Work> work = inbox.next(kKeptTime);
    if (work)
      answer(tasks(std::move(*work)));
    else
      tasks.forget();
  }
}

}  // namespace qtet
