// Tests what a connection notices of its client while it waits for a level.
#include <utility>  // before any Asio header: 1.74 uses std::exchange without it

#include "server/http/level_wait.h"

#include <gtest/gtest.h>

#include <array>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/write.hpp>
#include <functional>
#include <optional>
#include <thread>

#include "tests/server/program/served_folder.h"
#include "tests/server/store/held_maker.h"

namespace qtet {
namespace {

// Asio's reactor reports readiness some time after it learns of it. Bytes that were read in between
// wake the watch up for nothing.
TEST(LevelWait, aWakeUpForNothingLeavesTheClientWatched) {
  namespace asio = boost::asio;
  using asio::ip::tcp;
  test::ServedFolder folder;
  test::HeldMaker maker;
  LevelJobs jobs({1, 1, nullptr, std::ref(maker)});
  asio::io_context context;
  tcp::acceptor acceptor(context, {asio::ip::address_v4::loopback(), 0});
  std::optional<tcp::socket> client(context);
  client->connect(acceptor.local_endpoint());
  ClientSocket socket(acceptor.accept());
  asio::write(*client, asio::buffer("request", 7));
  while (socket.arrived() == Arrived::kNothing) std::this_thread::yield();
  std::optional<LevelAnswer> answer;
  asio::co_spawn(
      context,
      [&]() -> asio::awaitable<void> {
        std::array<char, 16> bytes;
        boost::system::error_code ec;
        EXPECT_EQ(socket.read(bytes, ec), 7u);
        answer = co_await waitForLevel(socket, jobs, {folder.store().find("noise"), 2});
      },
      asio::detached);
  while (maker.begun() == 0) context.run_one_for(std::chrono::milliseconds(10));
  while (context.run_one_for(test::kQuiet) != 0) continue;  // the wake-up
  EXPECT_FALSE(answer);
  client.reset();
  ASSERT_TRUE(test::eventually([&] { return context.poll(), answer.has_value(); }))
      << "the client's end was not seen";
  EXPECT_TRUE(std::holds_alternative<LevelRefusal>(*answer) &&
              std::get<LevelRefusal>(*answer) == LevelRefusal::kGone);
  maker.waitForStopped(1);
}

}  // namespace
}  // namespace qtet
