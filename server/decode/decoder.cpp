#include "server/decode/decoder.h"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/eventfd.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <ctime>
#include <string_view>
#include <vector>

#include "proto/sanitizer.h"
#include "server/decode/decoder_main.h"

namespace qtet {
namespace {

/// The variables that it needs: those of the loader and of sanitizers. It gets no other.
std::vector<char*> environmentOf() {
  std::vector<char*> out;
  for (char** entry = environ; *entry != nullptr; ++entry) {
    const std::string_view text = *entry;
    for (const std::string_view begin : {"LD_", "ASAN_", "UBSAN_", "LSAN_", "TSAN_"})
      if (text.starts_with(begin)) out.push_back(*entry);
  }
  out.push_back(nullptr);
  return out;
}

/// Files of a process to be: its end of the channel and standard error, and no others.
class Actions {
 public:
  explicit Actions(int channel) {
    ::posix_spawn_file_actions_init(&actions_);
    ::posix_spawn_file_actions_addopen(&actions_, STDIN_FILENO, "/dev/null", O_RDWR, 0);
    ::posix_spawn_file_actions_adddup2(&actions_, STDIN_FILENO, STDOUT_FILENO);
    ::posix_spawn_file_actions_adddup2(&actions_, channel, kDecoderChannel);
    ::posix_spawn_file_actions_addclosefrom_np(&actions_, kDecoderChannel + 1);
  }
  ~Actions() { ::posix_spawn_file_actions_destroy(&actions_); }
  Actions(const Actions&) = delete;
  Actions& operator=(const Actions&) = delete;
  [[nodiscard]] const posix_spawn_file_actions_t* get() const { return &actions_; }

 private:
  posix_spawn_file_actions_t actions_{};
};

/// All signals as they are by default, none blocked.
class Attributes {
 public:
  Attributes() {
    ::posix_spawnattr_init(&attributes_);
    sigset_t none, all;
    ::sigemptyset(&none), ::sigfillset(&all);
    ::posix_spawnattr_setsigmask(&attributes_, &none);
    ::posix_spawnattr_setsigdefault(&attributes_, &all);
    ::posix_spawnattr_setflags(&attributes_, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
  }
  ~Attributes() { ::posix_spawnattr_destroy(&attributes_); }
  Attributes(const Attributes&) = delete;
  Attributes& operator=(const Attributes&) = delete;
  [[nodiscard]] const posix_spawnattr_t* get() const { return &attributes_; }

 private:
  posix_spawnattr_t attributes_{};
};

void setLimit(pid_t process, __rlimit_resource which, std::uint64_t soft) {
  rlimit limit{};
  if (::prlimit(process, which, nullptr, &limit) != 0) return;
  limit.rlim_cur = std::min<rlim_t>(soft, limit.rlim_max);
  (void)::prlimit(process, which, &limit, nullptr);
}

/// Processor time that the process has used, rounded up.
std::chrono::seconds usedTime(pid_t process) {
  clockid_t clock{};
  timespec time{};
  if (::clock_getcpuclockid(process, &clock) != 0 || ::clock_gettime(clock, &time) != 0) return {};
  return std::chrono::seconds(time.tv_sec + 1);
}

std::string endText(int status) {
  if (WIFSIGNALED(status) && WTERMSIG(status) == SIGXCPU)
    return "the process that decoded it took too much processor time and was ended";
  if (WIFSIGNALED(status))
    return "the process that decoded it was ended by signal " + std::to_string(WTERMSIG(status)) +
           " (" + ::strsignal(WTERMSIG(status)) + ")";
  return "the process that decoded it ended with code " + std::to_string(WEXITSTATUS(status));
}

}  // namespace

Decoder::Decoder(Channel channel, pid_t process)
    : channel_(std::move(channel)),
      process_(process),
      wake_(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
  channel_.setPatience(limits::kDecoderMessageTime);
  setLimit(process_, RLIMIT_CORE, 0);
  setLimit(process_, RLIMIT_NOFILE, limits::kDecoderFiles);
}

Decoder::~Decoder() {
  if (process_ > 0) (void)lost();
}

bool Decoder::alive() const {
  pollfd end{channel_.number(), 0, 0};
  return process_ > 0 && (::poll(&end, 1, 0) == 0 || (end.revents & POLLHUP) == 0);
}

Result<std::unique_ptr<Decoder>> Decoder::start(const std::string& program) {
  auto ends = connectedEnds();
  if (!ends) return std::unexpected(ends.error());
  auto& [ours, theirs] = *ends;
  std::array<char*, 3> arguments = {const_cast<char*>("qtet-server"),
                                    const_cast<char*>(kDecoderArgument), nullptr};
  pid_t process = 0;
  const int failed = ::posix_spawn(&process, program.c_str(), Actions(theirs->number).get(),
                                   Attributes().get(), arguments.data(), environmentOf().data());
  if (failed != 0)
    return fail(ErrorCode::kIo,
                std::string("no process can be started that decodes it: ") + std::strerror(failed));
  return std::unique_ptr<Decoder>(new Decoder(Channel(std::move(ours)), process));
}

void Decoder::bound(const TaskLimits& bounds) const {
  if (!kSanitized) setLimit(process_, RLIMIT_DATA, bounds.memoryBytes);
  setLimit(process_, RLIMIT_FSIZE, bounds.fileBytes);
  const std::chrono::seconds end = usedTime(process_) + bounds.time;
  setLimit(process_, RLIMIT_CPU, static_cast<std::uint64_t>(end.count()));
}

std::unexpected<Error> Decoder::lost() {
  assert(process_ > 0);
  int status = 0;
  // One that is about to end by itself keeps its own reason.
  ::kill(process_, SIGKILL);
  while (::waitpid(process_, &status, 0) < 0 && errno == EINTR) {
  }
  process_ = -1;
  return fail(ErrorCode::kIo, endText(status));
}

Result<DecodeAnswer> Decoder::next(const std::stop_token& stop) {
  const std::stop_callback waker(stop, [this] {
    const std::uint64_t one = 1;
    (void)!::write(wake_.number, &one, sizeof one);
  });
  int patience = -1;
  for (;;) {
    std::array<pollfd, 2> ready = {pollfd{channel_.number(), POLLIN, 0},
                                   pollfd{wake_.number, POLLIN, 0}};
    const int count = ::poll(ready.data(), ready.size(), patience);
    if (count < 0 && errno == EINTR) continue;
    if (ready[0].revents != 0) break;
    if (count == 0) {  // it was asked to stop, and goes on
      (void)lost();
      return cancelled();
    }
    std::uint64_t requests = 0;
    (void)!::read(wake_.number, &requests, sizeof requests);
    if (!channel_.send(messageOf(StopTask()))) return lost();
    patience = static_cast<int>(std::chrono::milliseconds(limits::kDecoderStopTime).count());
  }
  const Result<DecodeMessage> message = channel_.receive();
  if (!message) return lost();
  Result<DecodeAnswer> answer = answerOf(message->bytes);
  if (!answer) (void)lost();
  return answer;
}

Result<DecodeAnswer> Decoder::ask(const DecodeTask& task, std::span<const int> files,
                                  const TaskLimits& bounds, const std::stop_token& stop) {
  assert(process_ > 0);
  std::uint64_t earlier = 0;
  (void)!::read(wake_.number, &earlier, sizeof earlier);  // stops of tasks that have ended
  if (!ready_) {
    const Result<DecodeAnswer> first = next(stop);
    if (!first) return std::unexpected(first.error());
    const auto* ready = std::get_if<DecoderReady>(&*first);
    if (ready == nullptr) return lost();
    ready_ = true, confined_ = ready->confined;
  }
  bound(bounds);
  if (!channel_.send(messageOf(task), files)) return lost();
  return next(stop);
}

}  // namespace qtet
