#include "server/store/folder_watch.h"

#include <poll.h>
#include <sys/eventfd.h>
#include <sys/inotify.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>

#include "server/store/store_limits.h"

namespace qtet {

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

  /// false: the end was asked for.
  bool wait(std::chrono::milliseconds time, bool& news) const {
    std::array<pollfd, 2> files = {pollfd{events, POLLIN, 0}, pollfd{end, POLLIN, 0}};
    (void)::poll(files.data(), files.size(), static_cast<int>(time.count()));
    news = (files[0].revents & POLLIN) != 0;
    return (files[1].revents & POLLIN) == 0;
  }
  /// The events' content does not matter: the folder is read anyway.
  void forgetEvents() const {
    alignas(inotify_event) std::array<char, 4096> scrap;
    while (::read(events, scrap.data(), scrap.size()) > 0) {
    }
  }
  void run() const {
    for (bool news = false; wait(limits::kFolderInterval, news);) {
      // A copy brings many events; it is over once nothing comes for a while.
      for (int rests = 0; news && rests < limits::kMaxFolderRests; ++rests) {
        forgetEvents();
        if (!wait(limits::kFolderRest, news)) return;
      }
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
