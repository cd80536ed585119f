#include <cassert>
#include <utility>  // before any Asio header: 1.74 uses std::exchange without it

#include "server/wire/turns.h"

#include <boost/asio/async_result.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/use_awaitable.hpp>

#include "server/wire/connection_limits.h"

namespace qtet {

namespace asio = boost::asio;

asio::execution_context::id Turns::id;

Turns& Turns::of(const asio::any_io_executor& executor) {
  return asio::use_service<Turns>(asio::query(executor, asio::execution::context));
}

asio::awaitable<void> Turns::take(asio::any_io_executor executor, Clock::duration behind) {
  auto start = [this, &executor, due = Clock::now() + behind](auto handler) {
    waiting_.emplace(due, [handler = std::move(handler)]() mutable { handler(); });
    if (!scheduled_) schedule(executor);
  };
  co_await asio::async_initiate<const asio::use_awaitable_t<>, void()>(std::move(start),
                                                                       asio::use_awaitable);
}

/// Posted twice: what the reactor finds stands behind what was posted before, and comes between.
void Turns::schedule(const asio::any_io_executor& executor) {
  scheduled_ = true;
  asio::post(executor,
             [this, executor] { asio::post(executor, [this, executor] { runFirst(executor); }); });
}

void Turns::runFirst(const asio::any_io_executor& executor) {
  assert(scheduled_ && !waiting_.empty());
  auto first = waiting_.extract(waiting_.begin());
  scheduled_ = false;
  if (!waiting_.empty()) schedule(executor);
  first.mapped()();
}

bool owesTurn(AddressLimits::Client* client, AddressLimits::Clock::time_point now) {
  return client != nullptr && client->debt(now) > limits::kMaxFreeTime;
}

asio::awaitable<void> takeTurn(asio::any_io_executor executor, AddressLimits::Client* client) {
  const auto owed = client != nullptr ? client->debt() : std::chrono::nanoseconds();
  co_await Turns::of(executor).take(executor, owed * limits::kTurnsBehind);
}

}  // namespace qtet
