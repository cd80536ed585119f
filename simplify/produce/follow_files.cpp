#include "simplify/produce/follow_files.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <csignal>
#include <filesystem>
#include <optional>
#include <system_error>
#include <thread>

namespace qtet {
namespace {

std::atomic<bool> wasStopped{false};
static_assert(std::atomic<bool>::is_always_lock_free);

/// Notices the signals that end a program, which goes on meanwhile.
class SignalNotice {
 public:
  SignalNotice() {
    wasStopped = false;
    for (std::size_t i = 0; i < kSignals.size(); ++i) {
      struct sigaction action{};
      action.sa_handler = [](int) { wasStopped = true; };
      action.sa_flags = SA_RESTART | SA_RESETHAND;  // a second one ends it at once
      ::sigaction(kSignals[i], &action, &before_[i]);
    }
  }
  SignalNotice(const SignalNotice&) = delete;
  SignalNotice& operator=(const SignalNotice&) = delete;
  ~SignalNotice() {
    for (std::size_t i = 0; i < kSignals.size(); ++i)
      ::sigaction(kSignals[i], &before_[i], nullptr);
  }

 private:
  static constexpr std::array kSignals{SIGINT, SIGTERM, SIGHUP};
  std::array<struct sigaction, kSignals.size()> before_{};
};

/// How a file looks from outside; nothing of one that is not there.
struct Sight {
  std::optional<std::filesystem::file_time_type> changed, folderChanged;
  std::uintmax_t bytes = 0;
  bool operator==(const Sight&) const = default;
};

std::optional<std::filesystem::file_time_type> changeOf(const std::filesystem::path& path) {
  std::error_code code;
  const auto time = std::filesystem::last_write_time(path, code);
  return code ? std::nullopt : std::optional(time);
}

std::vector<Sight> sightOf(const std::vector<std::string>& files) {
  std::vector<Sight> out;
  for (const std::filesystem::path path : files) {
    std::error_code code;
    const std::uintmax_t bytes = std::filesystem::file_size(path, code);
    out.push_back({changeOf(path), changeOf(path.has_parent_path() ? path.parent_path() : "."),
                   code ? 0 : bytes});
  }
  return out;
}

/// Sleeps, but not beyond a signal for long.
void pauseFor(std::chrono::milliseconds interval) {
  constexpr std::chrono::milliseconds kSlice{50};
  for (auto left = interval; left.count() > 0 && !wasStopped; left -= kSlice)
    std::this_thread::sleep_for(std::min(left, kSlice));
}

}  // namespace

void followFiles(const std::vector<std::string>& files, std::chrono::milliseconds interval,
                 const std::function<Result<bool>()>& pass, Console& console) {
  const SignalNotice notice;
  std::optional<std::vector<Sight>> seen;
  std::string lastError;
  while (!wasStopped) {
    std::vector<Sight> now = sightOf(files);
    if (now == seen) {
      pauseFor(interval);
      continue;
    }
    const Result<bool> done = pass();
    if (done) {
      lastError.clear();
      if (!*done) seen = std::move(now);
      continue;
    }
    if (done.error().message != lastError) console.warn(done.error().message + "; trying again");
    lastError = done.error().message;
    seen.reset();
    pauseFor(interval);
  }
}

}  // namespace qtet
