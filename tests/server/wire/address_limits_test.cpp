#include <utility>  // before any Asio header: 1.74 uses std::exchange without it

#include "server/wire/address_limits.h"

#include <gtest/gtest.h>

#include <boost/asio/ip/address.hpp>
#include <vector>

namespace qtet {
namespace {

using namespace std::chrono_literals;

boost::asio::ip::address at(const char* text) { return boost::asio::ip::make_address(text); }

TEST(AddressLimits, oneAddressHasAsManyConnectionsAsItMayHave) {
  AddressLimits limits(2, 0);
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
  AddressLimits limits(1, 0);
  const auto first = limits.enter(at("2001:db8:1:2::1"));
  EXPECT_TRUE(first);
  EXPECT_FALSE(limits.enter(at("2001:db8:1:2:ffff::9")));
  EXPECT_TRUE(limits.enter(at("2001:db8:1:3::1")));
}

TEST(AddressLimits, noBoundIsNoBound) {
  AddressLimits limits(0, 0);
  std::vector<std::unique_ptr<AddressLimits::Client>> all;
  for (int i = 0; i < 1000; ++i) {
    all.push_back(limits.enter(at("192.0.2.1")));
    ASSERT_TRUE(all.back());
    ASSERT_TRUE(all.back()->countRequest());
  }
}

TEST(AddressLimits, requestsAreForgivenSecondBySecondAndNotByConnectingAnew) {
  AddressLimits limits(0, 10);
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

TEST(AddressLimits, aPlaceMayOutliveTheLimits) {
  std::unique_ptr<AddressLimits::Client> client;
  {
    AddressLimits limits(1, 1);
    client = limits.enter(at("192.0.2.1"));
  }
  EXPECT_TRUE(client->countRequest());
}

}  // namespace
}  // namespace qtet
