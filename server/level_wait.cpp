#include <utility>  // before any Asio header: 1.74 uses std::exchange without it

#include "server/level_wait.h"

#include <sys/socket.h>

#include <boost/asio/async_result.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <cerrno>
#include <memory>
#include <optional>

namespace qtet {
namespace {

namespace asio = boost::asio;
using boost::system::error_code;

/// A coroutine's continuation, called by whoever comes first; only on the connection's executor.
template <class Handler>
class FirstAnswer {
 public:
  explicit FirstAnswer(Handler handler) : handler_(std::move(handler)) {}
  [[nodiscard]] bool pending() const { return handler_.has_value(); }
  void give(LevelAnswer answer) {
    if (!handler_) return;
    Handler handler = std::move(*handler_);
    handler_.reset();
    handler(std::move(answer));
  }
  LevelJobs::Wish wish;

 private:
  std::optional<Handler> handler_;
};

/// Whether a socket that became readable has ended; bytes of a next request are left where they are.
bool hasEnded(int socket) {
  char byte = 0;
  const ssize_t n = ::recv(socket, &byte, 1, MSG_PEEK | MSG_DONTWAIT);
  return n == 0 || (n < 0 && errno != EAGAIN && errno != EINTR);
}

}  // namespace

asio::awaitable<LevelAnswer> waitForLevel(asio::ip::tcp::socket& socket, LevelJobs& jobs, LevelRequest request) {
  auto start = [&socket, &jobs, request = std::move(request)](auto handler) {
    const auto first = std::make_shared<FirstAnswer<decltype(handler)>>(std::move(handler));
    const auto executor = socket.get_executor();
    std::optional<LevelJobs::Wish> wish = jobs.submit(request, [executor, first](Result<LevelFile> file) {
      // Back to the connection's own executor: a coroutine must not go on in the pool.
      asio::post(executor, [first, file = std::move(file)]() mutable { first->give(std::move(file)); });
    });
    if (!wish) {
      asio::post(executor, [first] { first->give(LevelRefusal::kBusy); });
      return;
    }
    first->wish = std::move(*wish);
    socket.async_wait(asio::socket_base::wait_read, [first, &socket](const error_code& ec) {
      // While the answer is pending the coroutine, and with it the socket, waits here.
      if (first->pending() && (ec || hasEnded(socket.native_handle()))) {
        first->wish = {};
        first->give(LevelRefusal::kGone);
      }
    });
  };
  LevelAnswer out = co_await asio::async_initiate<const asio::use_awaitable_t<>, void(LevelAnswer)>(std::move(start), asio::use_awaitable);
  error_code ec;
  socket.cancel(ec);  // the watch, if it still stands
  co_return out;
}

}  // namespace qtet
