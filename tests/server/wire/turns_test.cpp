#include <utility>  // before any Asio header: 1.74 uses std::exchange without it

#include "server/wire/turns.h"

#include <gtest/gtest.h>

#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/local/connect_pair.hpp>
#include <boost/asio/local/stream_protocol.hpp>
#include <boost/asio/post.hpp>
#include <string>

namespace qtet {
namespace {

namespace asio = boost::asio;
using namespace std::chrono_literals;

class TurnsTest : public ::testing::Test {
 protected:
  /// Appends `name` at each of its turns.
  asio::awaitable<void> play(char name, int times, Turns::Clock::duration behind) {
    const asio::any_io_executor executor = context_.get_executor();
    for (int i = 0; i < times; ++i) {
      co_await Turns::of(executor).take(executor, behind);
      order_ += name;
    }
  }
  void begin(char name, int times, Turns::Clock::duration behind = {}) {
    asio::co_spawn(context_, play(name, times, behind), asio::detached);
  }

  asio::io_context context_{1};
  std::string order_;
};

TEST_F(TurnsTest, equalsTakeTurns) {
  begin('a', 3);
  begin('b', 3);
  context_.run();
  EXPECT_EQ(order_, "ababab");
}

TEST_F(TurnsTest, whoIsBehindWaitsForAllOthersOfThatTime) {
  begin('a', 2, 1h);
  begin('b', 3);
  context_.run();
  EXPECT_EQ(order_, "bbbaa");
}

TEST_F(TurnsTest, whatArrivesIsSeenBetweenTwoTurns) {
  asio::local::stream_protocol::socket one(context_), other(context_);
  asio::local::connect_pair(one, other);
  one.async_wait(asio::socket_base::wait_read,
                 [this](const boost::system::error_code&) { order_ += '!'; });
  begin('a', 5);
  asio::post(context_, [&] { other.write_some(asio::buffer("x", 1)); });
  context_.run();
  EXPECT_LE(order_.find('!'), 1u) << order_;
}

TEST_F(TurnsTest, aContextMayGoWhileSomebodyWaits) {
  begin('a', 1);
  context_.run_one();
  EXPECT_EQ(order_, "");
}

}  // namespace
}  // namespace qtet
