#include <utility>  // before any Asio header: 1.74 uses std::exchange without it

#include "server/wire/address_limits.h"

#include <gtest/gtest.h>

#include <boost/asio/ip/address.hpp>
#include <thread>
#include <vector>

#include "server/wire/charge.h"
#include "server/wire/connection_limits.h"

namespace qtet {
namespace {

using namespace std::chrono_literals;

boost::asio::ip::address at(const char* text) { return boost::asio::ip::make_address(text); }

TEST(AddressLimits, oneAddressHasAsManyConnectionsAsItMayHave) {
  AddressLimits limits({2, 0});
  auto first = limits.enter(at("192.0.2.1"));
  const auto second = limits.enter(at("192.0.2.1"));
  EXPECT_TRUE(first && second);
  EXPECT_FALSE(limits.enter(at("192.0.2.1")));
  EXPECT_FALSE(limits.enter(at("::ffff:192.0.2.1"))) << "the same one, seen through IPv6";
  EXPECT_TRUE(limits.enter(at("192.0.2.2")));
  first.reset();
  EXPECT_TRUE(limits.enter(at("192.0.2.1")));
}

TEST(AddressLimits, aNetworkOfIPv6CountsAsOne) {
  AddressLimits limits({1, 0});
  const auto first = limits.enter(at("2001:db8:1:2::1"));
  EXPECT_TRUE(first);
  EXPECT_FALSE(limits.enter(at("2001:db8:1:2:ffff::9")));
  EXPECT_TRUE(limits.enter(at("2001:db8:1:3::1")));
}

TEST(AddressLimits, noBoundIsNoBound) {
  AddressLimits limits({0, 0});
  std::vector<std::unique_ptr<AddressLimits::Client>> all;
  for (int i = 0; i < 1000; ++i) {
    all.push_back(limits.enter(at("192.0.2.1")));
    ASSERT_TRUE(all.back());
    ASSERT_TRUE(all.back()->countRequest());
  }
}

TEST(AddressLimits, requestsAreForgivenSecondBySecondAndNotByConnectingAnew) {
  AddressLimits limits({0, 10});
  const auto start = AddressLimits::Clock::now();
  auto client = limits.enter(at("192.0.2.1"));
  for (int i = 0; i < 20; ++i) EXPECT_TRUE(client->countRequest(start)) << i;
  EXPECT_FALSE(client->countRequest(start));
  client = limits.enter(at("192.0.2.1"));
  EXPECT_FALSE(client->countRequest(start));
  EXPECT_TRUE(limits.enter(at("192.0.2.2"))->countRequest(start));
  for (int i = 0; i < 10; ++i) EXPECT_TRUE(client->countRequest(start + 1s)) << i;
  EXPECT_FALSE(client->countRequest(start + 1s));
}

TEST(AddressLimits, processorTimeIsBoundedAndForgivenSecondBySecond) {
  constexpr std::chrono::nanoseconds kMax = limits::kMaxOwedTime;
  const auto start = AddressLimits::Clock::now();
  for (const auto& [owed, may] :
       {std::pair(kMax - 1ns, true), {kMax, false}, {kMax + 1ns, false}}) {
    AddressLimits limits({0, 1000});
    auto client = limits.enter(at("192.0.2.1"));
    client->charge(owed / 2, start);
    limits.enter(at("192.0.2.1"))->charge(owed - owed / 2, start);
    EXPECT_EQ(client->debt(start), owed);
    EXPECT_EQ(client->overdrawn(start), !may);
    EXPECT_EQ(client->countRequest(start), may);
    EXPECT_TRUE(limits.enter(at("192.0.2.2"))->countRequest(start));
    EXPECT_TRUE(client->countRequest(start + 1s));
    EXPECT_EQ(client->debt(start + 1s), owed - limits::kProcessorTimePerSecond);
    EXPECT_EQ(client->debt(start + 150s + 1us), 0ns);
  }
}

TEST(AddressLimits, whereRequestsHaveNoBoundProcessorTimeHasNone) {
  AddressLimits limits({0, 0});
  const auto client = limits.enter(at("192.0.2.1"));
  client->charge(1h);
  EXPECT_EQ(client->debt(), 0ns);
  EXPECT_TRUE(client->countRequest());
}

TEST(AddressLimits, aChargeIsTheThreadsTimeNotTheWait) {
  AddressLimits limits({0, 1000});
  const auto client = limits.enter(at("192.0.2.1"));
  {
    const Charge charge(client.get());
    std::this_thread::sleep_for(30ms);
  }
  EXPECT_LT(client->debt(), 20ms);
  const Charge nobody(nullptr);
}

TEST(AddressLimits, aChargeIsNoLessThanTheThreadHasWorked) {
  AddressLimits limits({0, 1000});
  const auto client = limits.enter(at("192.0.2.1"));
  const auto worked = [] {
    timespec time{};
    (void)::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return std::chrono::seconds(time.tv_sec) + std::chrono::nanoseconds(time.tv_nsec);
  };
  {
    const Charge charge(client.get());
    for (const auto end = worked() + 30ms; worked() < end;) continue;
  }
  EXPECT_GT(client->debt(), 20ms);
}

TEST(AddressLimits, aPlaceMayOutliveTheLimits) {
  std::unique_ptr<AddressLimits::Client> client;
  {
    AddressLimits limits({1, 1});
    client = limits.enter(at("192.0.2.1"));
  }
  EXPECT_TRUE(client->countRequest());
}

}  // namespace
}  // namespace qtet
