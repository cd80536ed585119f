#include "server/store/folder_watch.h"

#include <poll.h>
#include <sys/eventfd.h>
#include <sys/inotify.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>

#include "server/store/folder_names.h"
#include "server/store/store_limits.h"

namespace qtet {

using namespace std::chrono_literals;

bool tellOfLogs(ByteView events) {
  while (events.size() >= sizeof(inotify_event)) {
    inotify_event event;
    std::memcpy(&event, events.data(), sizeof(event));
    events = events.subspan(sizeof(event));
    const std::size_t padded = std::min<std::size_t>(event.len, events.size());
    const char* text = reinterpret_cast<const char*>(events.data());
    const std::string_view name(text, ::strnlen(text, padded));
    if (name.empty() || (name.ends_with(kLogSuffix) && !name.starts_with('.'))) return true;
    events = events.subspan(padded);
  }
  return false;
}

struct FolderWatch::State {
  int events = -1;
  int end = -1;
  std::function<void()> changed;
  std::jthread thread;

  ~State() {
    const std::uint64_t one = 1;
    if (end >= 0) (void)!::write(end, &one, sizeof(one));
    if (thread.joinable()) thread.join();
    if (events >= 0) ::close(events);
    if (end >= 0) ::close(end);
  }

  enum class News { kNone, kOthers, kLogs, kEnd };

  /// Until something happens; kNone: nothing has for that time.
  News wait(std::chrono::milliseconds time) const {
    std::array<pollfd, 2> files = {pollfd{events, POLLIN, 0}, pollfd{end, POLLIN, 0}};
    (void)::poll(files.data(), files.size(), static_cast<int>(time.count()));
    if ((files[1].revents & POLLIN) != 0) return News::kEnd;
    if ((files[0].revents & POLLIN) == 0) return News::kNone;
    alignas(inotify_event) std::array<std::uint8_t, 4096> read;
    bool logs = false;
    for (ssize_t count = 0; (count = ::read(events, read.data(), read.size())) > 0;)
      logs = tellOfLogs(ByteView(read).first(static_cast<std::size_t>(count))) || logs;
    return logs ? News::kLogs : News::kOthers;
  }
  /// Until something happens to a log; kNone: nothing has for that time, whatever else has.
  News waitForLogs(std::chrono::milliseconds time) const {
    using Clock = std::chrono::steady_clock;
    const Clock::time_point until = Clock::now() + time;
    for (auto left = time; left >= 0ms;
         left = std::chrono::floor<std::chrono::milliseconds>(until - Clock::now()))
      if (const News news = wait(left); news != News::kOthers) return news;
    return News::kNone;
  }
  void run() const {
    for (News news = News::kNone; (news = waitForLogs(limits::kFolderInterval)) != News::kEnd;) {
      // A copy brings many events; it is over once nothing comes for a while.
      for (int rests = 0; news == News::kLogs && rests < limits::kMaxFolderRests; ++rests)
        news = waitForLogs(limits::kFolderRest);
      if (news == News::kEnd) return;
      changed();
    }
  }
};

FolderWatch::FolderWatch(std::unique_ptr<State> state) : state_(std::move(state)) {}
FolderWatch::FolderWatch(FolderWatch&&) noexcept = default;
FolderWatch::~FolderWatch() = default;

Result<FolderWatch> FolderWatch::start(const std::filesystem::path& folder,
                                       std::function<void()> changed) {
  auto state = std::make_unique<State>();
  state->changed = std::move(changed);
  state->end = ::eventfd(0, EFD_CLOEXEC);
  state->events = ::inotify_init1(IN_CLOEXEC | IN_NONBLOCK);
  constexpr std::uint32_t kEvents =
      IN_CLOSE_WRITE | IN_MOVED_TO | IN_MOVED_FROM | IN_DELETE | IN_CREATE | IN_ATTRIB;
  if (state->end < 0 || state->events < 0 ||
      ::inotify_add_watch(state->events, folder.c_str(), kEvents) < 0)
    return fail(ErrorCode::kIo,
                folder.string() + " cannot be watched: " + std::strerror(errno) +
                    "; raise fs.inotify.max_user_watches, or start with --watch off");
  state->thread = std::jthread([raw = state.get()] { raw->run(); });
  return FolderWatch(std::move(state));
}

}  // namespace qtet
