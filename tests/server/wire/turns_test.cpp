#include <utility>  // before any Asio header: 1.74 uses std::exchange without it

#include "server/wire/turns.h"

#include <gtest/gtest.h>

#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/address.hpp>
#include <boost/asio/local/connect_pair.hpp>
#include <boost/asio/local/stream_protocol.hpp>
#include <boost/asio/post.hpp>
#include <memory>
#include <string>

#include "server/wire/connection_limits.h"

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

/// Clients of addresses of their own.
class Clients {
 public:
  std::unique_ptr<AddressLimits::Client> owing(std::chrono::nanoseconds time) {
    auto client = limits_.enter(boost::asio::ip::address_v4(++last_));
    client->charge(time, start_);
    return client;
  }
  [[nodiscard]] AddressLimits::Clock::time_point start() const { return start_; }

 private:
  AddressLimits limits_{{0, 1000}};
  AddressLimits::Clock::time_point start_ = AddressLimits::Clock::now();
  std::uint32_t last_ = 0;
};

TEST(OwesTurn, isWhoHasTakenMoreThanTheFreeTime) {
  Clients clients;
  for (const std::chrono::nanoseconds more : {-1ns, 0ns, 1ns}) {
    const auto client = clients.owing(limits::kMaxFreeTime + more);
    EXPECT_EQ(owesTurn(client.get(), clients.start()), more > 0ns) << more.count();
    EXPECT_FALSE(owesTurn(client.get(), clients.start() + 1s)) << "it is forgiven by then";
  }
  EXPECT_FALSE(owesTurn(nullptr));
}

/// Debts of hours: so much is not forgiven while the test runs.
class TakeTurnTest : public TurnsTest {
 protected:
  void comes(char name, AddressLimits::Client* client) {
    asio::co_spawn(context_, turn(name, client), asio::detached);
  }

  Clients clients_;

 private:
  asio::awaitable<void> turn(char name, AddressLimits::Client* client) {
    co_await takeTurn(context_.get_executor(), client);
    order_ += name;
  }
};

TEST_F(TakeTurnTest, whoOwesLessGoesFirstAndWhoHasNoBoundsOwesNothing) {
  const auto much = clients_.owing(3h), little = clients_.owing(2h), nothing = clients_.owing(0h);
  comes('m', much.get());
  comes('l', little.get());
  comes('n', nothing.get());
  comes('0', nullptr);
  context_.run();
  EXPECT_EQ(order_, "n0lm");
}

TEST_F(TakeTurnTest, whatIsOwedCountsAsTimeSoManyTimesOver) {
  const auto client = clients_.owing(1h);
  begin('>', 1, limits::kTurnsBehind * 1h + 1min);
  comes('=', client.get());
  begin('<', 1, limits::kTurnsBehind * 1h - 1min);
  context_.run();
  EXPECT_EQ(order_, "<=>");
}

TEST_F(TurnsTest, aContextMayGoWhileSomebodyWaits) {
  begin('a', 1);
  context_.run_one();
  EXPECT_EQ(order_, "");
}

}  // namespace
}  // namespace qtet
