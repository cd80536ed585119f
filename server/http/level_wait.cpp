#include <utility>  // before any Asio header: 1.74 uses std::exchange without it

#include "server/http/level_wait.h"

#include <boost/asio/async_result.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <expected>
#include <memory>
#include <optional>

#include "server/http/client_watch.h"

namespace qtet {
namespace {

namespace asio = boost::asio;

/// A coroutine's continuation, called once by the first event. Only on the connection's executor.
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
  LevelJobs::Subscription subscription;

 private:
  std::optional<Handler> handler_;
};

}  // namespace

asio::awaitable<LevelAnswer> waitForLevel(ClientSocket& socket, LevelJobs& jobs,
                                          LevelRequest request, LevelJobs::Address from) {
  auto start = [&socket, &jobs, request = std::move(request), from](auto handler) {
    const auto first = std::make_shared<FirstAnswer<decltype(handler)>>(std::move(handler));
    const auto executor = socket.get_executor();
    std::expected<LevelJobs::Subscription, LevelRefusal> subscription = jobs.submit(
        request,
        [executor, first](Result<LevelFile> file) {
          // Back to the connection's own executor: a coroutine must not go on in the pool.
          asio::post(executor,
                     [first, file = std::move(file)]() mutable { first->give(std::move(file)); });
        },
        from);
    if (!subscription) {
      asio::post(executor, [first, refusal = subscription.error()] { first->give(refusal); });
      return;
    }
    first->subscription = std::move(*subscription);
    watchForEnd(
        socket, [first] { return first->pending(); },
        [first] {
          first->subscription = {};
          first->give(LevelRefusal::kGone);
        });
  };
  LevelAnswer out = co_await asio::async_initiate<const asio::use_awaitable_t<>, void(LevelAnswer)>(
      std::move(start), asio::use_awaitable);
  socket.cancel();  // the watch, if it still stands
  co_return out;
}

}  // namespace qtet
