#include "server/decode/decoders.h"

#include <fcntl.h>
#include <spdlog/spdlog.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cerrno>
#include <condition_variable>
#include <cstring>
#include <mutex>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "server/decode/decoder.h"

namespace qtet {
namespace {

/// A check may decode this much longer than its own limit before the system ends it.
constexpr std::chrono::seconds kCheckMargin{10};
/// A log that was forged to scatter its stars may take three times the memory that is foretold.
constexpr std::uint64_t kForgedFactor = 3;

/// A file in memory that a level is written into. -1: there is none, and errno says why.
int fileForLevel() { return ::memfd_create("qtet-level", MFD_CLOEXEC | MFD_ALLOW_SEALING); }

/// The bytes that the process wrote. From now on it can change nothing in them. Errors: io.
Result<LevelFile> levelIn(const Descriptor& file) {
  struct stat info{};
  if (::fcntl(file.number, F_ADD_SEALS, F_SEAL_SHRINK | F_SEAL_GROW | F_SEAL_WRITE) != 0 ||
      ::fstat(file.number, &info) != 0)
    return fail(ErrorCode::kIo, std::string("the level cannot be read: ") + std::strerror(errno));
  const auto size = static_cast<std::size_t>(info.st_size);
  if (size == 0) return LevelFile();
  void* address = ::mmap(nullptr, size, PROT_READ, MAP_SHARED, file.number, 0);
  if (address == MAP_FAILED)
    return fail(ErrorCode::kIo, std::string("the level cannot be read: ") + std::strerror(errno));
  return LevelFile{{static_cast<const std::uint8_t*>(address), size},
                   {address, [size](void* mapped) { ::munmap(mapped, size); }}};
}

}  // namespace

struct Decoders::State {
  struct Place {
    std::unique_ptr<Decoder> decoder{};  // nullptr: it has ended, or could not be started
    std::string subject{};               // what it has in memory
    std::uint64_t used = 0;              // when its last task ended, counted in tasks
    bool busy = false;
  };

  explicit State(DecoderOptions given) : options(std::move(given)), places(options.processes) {}

  /// A place that is this task's alone.
  struct Taken {
    Taken(State& from, const std::string& subject) : state(from), place(from.take(subject)) {}
    ~Taken() { state.giveBack(place); }
    Taken(const Taken&) = delete;
    Taken& operator=(const Taken&) = delete;
    State& state;
    Place& place;
  };

  /// The answer of a process that is idle. `subject` names what it may have in memory, `what` the
  /// task in the server's log.
  Result<DecodeAnswer> ask(const DecodeTask& task, std::span<const int> files,
                           const TaskLimits& bounds, const std::stop_token& stop,
                           const std::string& subject, const std::string& what);
  Status start(Place& place);
  void countLost(const std::string& how);
  /// Waits for an idle one: that of the subject, or the one that has been idle for longest.
  Place& take(const std::string& subject);
  void giveBack(Place& place);
  void warnUnconfined(const Decoder& decoder);

  const DecoderOptions options;
  std::mutex mutex;
  std::condition_variable idle;
  std::vector<Place> places;  // guarded by `mutex`, but for the decoder of one that is busy
  DecoderCounts counts;
  std::uint64_t tasks = 0;
  bool warned = false;
};

Decoders::State::Place& Decoders::State::take(const std::string& subject) {
  std::unique_lock lock(mutex);
  const auto isIdle = [](const Place& place) { return !place.busy; };
  idle.wait(lock, [&] { return std::ranges::any_of(places, isIdle); });
  const auto rank = [&](const Place& place) {
    return std::tuple(place.busy, place.subject != subject, place.used);
  };
  Place& best = *std::ranges::min_element(places, {}, rank);
  assert(!best.busy && counts.running < places.size());
  best.busy = true;
  best.subject = subject;
  ++counts.running;
  return best;
}

void Decoders::State::giveBack(Place& place) {
  const std::scoped_lock lock(mutex);
  assert(place.busy && counts.running > 0);
  place.busy = false;
  place.used = ++tasks;
  --counts.running;
  idle.notify_one();
}

void Decoders::State::warnUnconfined(const Decoder& decoder) {
  const std::scoped_lock lock(mutex);
  if (decoder.confined() || !decoder.alive() || std::exchange(warned, true)) return;
  spdlog::warn(
      "this system has no seccomp filters: the processes that decode are bounded in memory and "
      "time, but could open files");
}

Status Decoders::State::start(Place& place) {
  Result<std::unique_ptr<Decoder>> started = Decoder::start(options.program);
  place.decoder = started ? std::move(*started) : nullptr;
  return started ? Status() : std::unexpected(started.error());
}

void Decoders::State::countLost(const std::string& how) {
  spdlog::error("{}; other requests are not affected", how);
  const std::scoped_lock lock(mutex);
  ++counts.lost;
}

Result<DecodeAnswer> Decoders::State::ask(const DecodeTask& task, std::span<const int> files,
                                          const TaskLimits& bounds, const std::stop_token& stop,
                                          const std::string& subject, const std::string& what) {
  const Taken taken(*this, subject);
  Place& place = taken.place;
  if (place.decoder && !place.decoder->alive()) {
    countLost("an idle process that decodes has ended");
    place.decoder = nullptr;
  }
  if (!place.decoder)
    if (const Status started = start(place); !started) return std::unexpected(started.error());
  Result<DecodeAnswer> answer = place.decoder->ask(task, files, bounds, stop);
  warnUnconfined(*place.decoder);
  if (place.decoder->alive()) return answer;
  if (!answer && answer.error().code != ErrorCode::kCancelled)
    countLost(what + ": " + answer.error().message);
  (void)start(place);  // so that the next task need not wait for it
  return answer;
}

Decoders::Decoders(DecoderOptions options) : state_(std::make_unique<State>(std::move(options))) {
  for (State::Place& place : state_->places) (void)state_->start(place);
}

Decoders::~Decoders() { assert(counts().running == 0); }

Result<LevelFile> Decoders::level(const LevelRequest& request, const std::stop_token& stop) {
  const Descriptor file(fileForLevel());
  if (file.number < 0)
    return fail(ErrorCode::kIo, std::string("there is no file for it: ") + std::strerror(errno));
  LevelTask task{request.mesh->log.digest(), request};
  task.request.mesh = nullptr;
  const std::array files = {request.mesh->descriptor->number, file.number};
  const TaskLimits bounds{state_->options.levelBytes + limits::kDecoderBaseBytes,
                          state_->options.levelBytes, limits::kLevelTime};
  const std::string& digest = task.digest;
  // A level makes its process forget what the next point needs.
  const std::string subject = (request.point ? "points of " : "levels of ") + digest;
  const Result<DecodeAnswer> answer =
      state_->ask(task, files, bounds, stop, subject,
                  request.mesh->id + " (" + digest + "), level " + std::to_string(request.level) +
                      " as " + std::string(formName(request.form)));
  if (!answer) return std::unexpected(answer.error());
  const auto* end = std::get_if<LevelEnd>(&*answer);
  if (end == nullptr) return fail(ErrorCode::kIo, "the process that decoded it answered nonsense");
  if (!end->status) return std::unexpected(end->status.error());
  return levelIn(file);
}

CheckVerdict Decoders::check(const ServedMesh& mesh, const CheckLimits& limits,
                             const std::stop_token& stop) {
  const TaskLimits bounds{kForgedFactor * limits.bytes + limits::kDecoderBaseBytes, 0,
                          std::chrono::ceil<std::chrono::seconds>(limits.time) + kCheckMargin};
  const std::array files = {mesh.descriptor->number};
  Result<DecodeAnswer> answer = state_->ask(CheckTask{limits}, files, bounds, stop, "checks",
                                            mesh.id + ": the check of a log");
  if (!answer) {
    const bool stopped = answer.error().code == ErrorCode::kCancelled;
    return {stopped ? CheckVerdict::End::kBusy : CheckVerdict::End::kFailed,
            stopped ? "the check was broken off"
                    : "the log could not be checked: " + answer.error().message};
  }
  auto* verdict = std::get_if<CheckVerdict>(&*answer);
  if (verdict != nullptr) return std::move(*verdict);
  return {CheckVerdict::End::kFailed, "the process that decoded it answered nonsense"};
}

std::vector<pid_t> Decoders::processes() const {
  std::vector<pid_t> out;
  for (const State::Place& place : state_->places)
    if (place.decoder) out.push_back(place.decoder->process());
  return out;
}

DecoderCounts Decoders::counts() const {
  const std::scoped_lock lock(state_->mutex);
  return state_->counts;
}

}  // namespace qtet
