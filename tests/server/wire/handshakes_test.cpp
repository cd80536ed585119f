// Who has a place, who waits for it, and who loses it.
#include "server/wire/handshakes.h"

#include <gtest/gtest.h>

#include <array>
#include <boost/asio/io_context.hpp>
#include <memory>
#include <vector>

namespace qtet {
namespace {

using namespace std::chrono_literals;

class HandshakesTest : public ::testing::Test {
 protected:
  struct Client {
    Client(HandshakesTest& test, Handshakes& handshakes, const void* address)
        : handshake(handshakes, test.context_.get_executor(), [this] { ++woken; }, address) {}
    [[nodiscard]] bool enters() { return !handshake.enter(); }
    int woken = 0;
    Handshakes::Client handshake;
  };
  std::unique_ptr<Client> client(Handshakes& handshakes, const void* address = nullptr) {
    return std::make_unique<Client>(*this, handshakes, address);
  }
  void settle() {
    context_.restart();
    context_.poll();
  }
  boost::asio::io_context context_;
};

TEST_F(HandshakesTest, thereAreSoManyPlacesAndALineInOrderOfComing) {
  Handshakes handshakes({.most = 2, .patience = 1h});
  auto a = client(handshakes), b = client(handshakes), c = client(handshakes),
       d = client(handshakes);
  EXPECT_TRUE(a->enters());
  EXPECT_TRUE(b->enters());
  EXPECT_FALSE(c->enters());
  EXPECT_FALSE(d->enters());
  EXPECT_EQ(handshakes.counts().open, 2u);
  EXPECT_EQ(handshakes.counts().waiting, 2u);
  a.reset();
  settle();
  EXPECT_EQ(c->woken, 1);
  EXPECT_EQ(d->woken, 0);
  EXPECT_FALSE(d->enters()) << "not before its turn";
  EXPECT_TRUE(c->enters());
  b.reset();
  settle();
  EXPECT_EQ(d->woken, 2) << "as the first in line, and as a place came free";
  EXPECT_TRUE(d->enters());
  EXPECT_EQ(handshakes.counts().waiting, 0u);
  EXPECT_EQ(handshakes.counts().displaced, 0u);
}

TEST_F(HandshakesTest, whoLeavesTheLineMakesRoomForWhoeverIsBehind) {
  Handshakes handshakes({.most = 1, .patience = 1h});
  auto a = client(handshakes), b = client(handshakes), c = client(handshakes);
  EXPECT_TRUE(a->enters());
  EXPECT_FALSE(b->enters());
  EXPECT_EQ(c->handshake.enter(), Handshakes::Clock::time_point::max())
      << "it need not look before it is the first";
  b.reset();
  settle();
  EXPECT_EQ(c->woken, 1);
  const auto again = c->handshake.enter();
  ASSERT_TRUE(again);
  EXPECT_LT(*again, Handshakes::Clock::now() + 2h);
  EXPECT_EQ(handshakes.counts().waiting, 1u);
}

TEST_F(HandshakesTest, thePlaceOfTheSlowestGoesToTheFirstInLine) {
  Handshakes handshakes({.most = 2, .patience = 0h});
  auto a = client(handshakes), b = client(handshakes), c = client(handshakes);
  EXPECT_TRUE(a->enters());
  EXPECT_TRUE(b->enters());
  settle();
  EXPECT_EQ(a->woken, 0) << "as long as nobody wants it";
  EXPECT_TRUE(c->enters());
  settle();
  EXPECT_EQ(a->woken, 1);
  EXPECT_EQ(b->woken, 0);
  EXPECT_EQ(handshakes.counts().open, 2u);
  EXPECT_EQ(handshakes.counts().displaced, 1u);
  a.reset();
  EXPECT_EQ(handshakes.counts().open, 2u) << "what it leaves it had lost already";
}

TEST_F(HandshakesTest, whoStallsFromSixAddressesLeavesPlacesToOthers) {
  Handshakes handshakes({.patience = 1h});
  const std::array<int, 6> addresses{};
  std::vector<std::unique_ptr<Client>> silent;
  for (const int& address : addresses)
    for (std::size_t i = 0; i < 200; ++i) {
      silent.push_back(client(handshakes, &address));
      EXPECT_EQ(silent.back()->enters(), i < limits::kMaxHandshakesPerAddress) << i;
    }
  EXPECT_EQ(handshakes.counts().open, 6 * limits::kMaxHandshakesPerAddress);
  EXPECT_EQ(handshakes.counts().waiting, 1200 - 6 * limits::kMaxHandshakesPerAddress);
  EXPECT_TRUE(client(handshakes, &handshakes)->enters());
  EXPECT_TRUE(client(handshakes)->enters()) << "without an address";
  settle();
  silent.clear();
  EXPECT_EQ(handshakes.counts().open + handshakes.counts().waiting, 0u);
}

TEST_F(HandshakesTest, whoStandsAsideFollowsInOrderWhenOneOfItsAddressLeaves) {
  Handshakes handshakes({.most = 2, .ofAddress = 1, .patience = 1h});
  const int here = 0, there = 0;
  auto a = client(handshakes, &here), b = client(handshakes, &here), c = client(handshakes, &here),
       other = client(handshakes, &there);
  EXPECT_TRUE(a->enters());
  EXPECT_FALSE(b->enters());
  EXPECT_EQ(c->handshake.enter(), Handshakes::Clock::time_point::max());
  EXPECT_TRUE(other->enters());
  b.reset();
  settle();
  EXPECT_EQ(c->woken, 1) << "as the first aside";
  EXPECT_FALSE(c->enters());
  a.reset();
  settle();
  EXPECT_GT(c->woken, 1);
  EXPECT_TRUE(c->enters());
}

TEST_F(HandshakesTest, whoStandsAsideTakesThePlaceOfTheSlowestOfItsOwnAddress) {
  Handshakes handshakes({.most = 9, .ofAddress = 1, .patience = 0h});
  const int here = 0, there = 0;
  auto other = client(handshakes, &there), a = client(handshakes, &here),
       b = client(handshakes, &here);
  EXPECT_TRUE(other->enters());
  EXPECT_TRUE(a->enters());
  EXPECT_TRUE(b->enters());
  settle();
  EXPECT_EQ(a->woken, 1);
  EXPECT_EQ(other->woken, 0);
  EXPECT_EQ(handshakes.counts().open, 2u);
  EXPECT_EQ(handshakes.counts().displaced, 1u);
}

TEST_F(HandshakesTest, aCallThatComesTooLateIsNotHeard) {
  Handshakes handshakes({.most = 1, .patience = 1h});
  auto a = client(handshakes), b = client(handshakes);
  EXPECT_TRUE(a->enters());
  EXPECT_FALSE(b->enters());
  a.reset();  // calls b
  EXPECT_TRUE(b->enters()) << "of itself, before it heard the call";
  settle();
  EXPECT_EQ(b->woken, 0) << "or its handshake were cut short";
  auto c = client(handshakes);
  EXPECT_FALSE(c->enters());
  b.reset();
  c.reset();
  settle();  // a call to who has gone
}

}  // namespace
}  // namespace qtet
