#include <utility>  // before any Asio header: 1.74 uses std::exchange without it

#include "server/wire/trusted_proxies.h"

#include <gtest/gtest.h>

#include <boost/asio/ip/address.hpp>
#include <initializer_list>
#include <random>
#include <string>
#include <vector>

#include "server/wire/proxy_head.h"

namespace qtet {
namespace {

namespace ip = boost::asio::ip;

Networks networks(std::string_view list) {
  Result<Networks> out = Networks::parse(list);
  EXPECT_TRUE(out) << list;
  return out ? *out : Networks();
}

TEST(TrustedProxies, blocksHoldTheirAddressesHoweverTheseAreWritten) {
  const Networks some = networks("10.0.0.0/8, 192.0.2.7,2001:db8::/32,::1");
  for (const char* in : {"10.1.2.3", "::ffff:10.1.2.3", "192.0.2.7", "2001:db8:1::9", "::1"})
    EXPECT_TRUE(some.contains(ip::make_address(in))) << in;
  for (const char* out : {"11.0.0.1", "192.0.2.8", "2001:db9::1", "::2", "0.0.0.1"})
    EXPECT_FALSE(some.contains(ip::make_address(out))) << out;
  EXPECT_TRUE(networks("10.9.8.7/8").contains(ip::make_address("10.0.0.1")))
      << "bits behind the prefix do not count";
  EXPECT_TRUE(networks("0.0.0.0/0").contains(ip::make_address("8.8.8.8")));
  EXPECT_TRUE(networks("").empty());
}

TEST(TrustedProxies, whatIsNoBlockIsRefused) {
  for (const char* wrong : {"10.0.0.0/33", "10.0.0/8", "2001:db8::/129", "10.0.0.0/-1",
                            "10.0.0.0/8x", "10.0.0.0/", "proxy.example", "10.0.0.1,,10.0.0.2"}) {
    const Result<Networks> read = Networks::parse(wrong);
    ASSERT_FALSE(read) << wrong;
    EXPECT_EQ(read.error().code, ErrorCode::kBadValue);
  }
}

/// The proxy at the other end of the connection.
constexpr const char* kSender = "10.0.0.9";

std::string clientOf(std::string_view value, ProxyHeader header = ProxyHeader::kForwardedFor) {
  const TrustedProxies proxies{networks("10.0.0.0/8"), header};
  return forwardedClient(proxies, ip::make_address(kSender), value).to_string();
}

TEST(TrustedProxies, theLastAddressThatIsNoProxysIsTheClients) {
  EXPECT_EQ(clientOf("203.0.113.9"), "203.0.113.9");
  EXPECT_EQ(clientOf("203.0.113.9, 10.0.0.1, 10.0.0.2"), "203.0.113.9");
  EXPECT_EQ(clientOf("6.6.6.6, 203.0.113.9,10.0.0.1"), "203.0.113.9")
      << "a client may write what it likes in front";
  EXPECT_EQ(clientOf("10.0.0.5, 10.0.0.1"), "10.0.0.5") << "a client in the proxies' own network";
  EXPECT_EQ(clientOf("203.0.113.9:4711"), "203.0.113.9");
  EXPECT_EQ(clientOf("2001:db8::7"), "2001:db8::7");
  EXPECT_EQ(clientOf("[2001:db8::7]:4711"), "2001:db8::7");
  EXPECT_EQ(clientOf("::ffff:203.0.113.9"), "203.0.113.9");
  EXPECT_EQ(clientOf("10.0.0.5"), "10.0.0.5");
}

TEST(TrustedProxies, whereTheListNamesNoAddressItIsBelievedNoFurther) {
  for (const char* nobody : {"", " ", "unknown", "6.6.6.6, unknown", "6.6.6.6, ", "[::1", "1.2.3"})
    EXPECT_EQ(clientOf(nobody), kSender) << nobody;
  EXPECT_EQ(clientOf("6.6.6.6, unknown, 10.0.0.1"), "10.0.0.1");
}

TEST(TrustedProxies, aPlaceThatIsNoAddressCountsAsTheProxysOwn) {
  for (const std::string nobody : {",",
                                   ", ,",
                                   "6.6.6.6,",
                                   "_x",
                                   "_hidden:4711",
                                   "unix:",
                                   "[2001:db8::7]4711",
                                   "[2001:db8::7]:",
                                   "[2001:db8::7]:x",
                                   "[2001:db8::7",
                                   "2001:db8::7]",
                                   "[]",
                                   "[]:1",
                                   "[203.0.113.9]",
                                   "[203.0.113.9]:1",
                                   "203.0.113.9:",
                                   "203.0.113.9:x",
                                   "203.0.113.9:123456",
                                   "203.0.113.9:_",
                                   "203.0.113.9:1:2",
                                   "203.0.113.9;203.0.113.8",
                                   "203.0.113.9 203.0.113.8",
                                   "203.0.113.256",
                                   "0x7f.1",
                                   "fe80::1%1",
                                   "fe80::1%eth0",
                                   "\"203.0.113.9\"",
                                   "\xFF\xFE"}) {
    EXPECT_EQ(clientOf(nobody), kSender) << nobody;
    EXPECT_EQ(clientOf("203.0.113.9, " + nobody), kSender) << nobody;
    EXPECT_EQ(clientOf(nobody + ", 203.0.113.9"), "203.0.113.9") << nobody;
    EXPECT_EQ(clientOf(nobody + ", 10.0.0.1"), "10.0.0.1") << nobody;
  }
  EXPECT_EQ(clientOf("203.0.113.9:_hidden"), "203.0.113.9") << "RFC 7239 lets ports be hidden";
  EXPECT_EQ(clientOf("203.0.113.9:12345"), "203.0.113.9");
  for (const char filling : {'1', ':', '[', ',', '.', ' ', '_'})
    EXPECT_EQ(clientOf(std::string(1'000'000, filling)), kSender) << filling;
}

TEST(TrustedProxies, anyBytesNameAnAddressOrTheProxy) {
  std::mt19937 random(2);
  const std::string alphabet = "0123456789abcdef:.[]%,; \"=_forFOR";
  for (int i = 0; i < 20'000; ++i) {
    std::string list;
    for (std::size_t n = random() % 40; n > 0; --n) list += alphabet[random() % alphabet.size()];
    for (const ProxyHeader header : {ProxyHeader::kForwardedFor, ProxyHeader::kForwarded}) {
      EXPECT_NE(clientOf(list, header), "");
      EXPECT_EQ(clientOf(list + ",unknown", header), kSender) << list;
      EXPECT_EQ(clientOf(list + ",for=203.0.113.9", ProxyHeader::kForwarded), "203.0.113.9")
          << list;
    }
  }
}

TEST(TrustedProxies, forwardedIsReadAsRfc7239WritesIt) {
  const auto of = [](std::string_view value) { return clientOf(value, ProxyHeader::kForwarded); };
  EXPECT_EQ(of("for=203.0.113.9;proto=https;by=10.0.0.1"), "203.0.113.9");
  EXPECT_EQ(of("proto=https; For=\"[2001:db8::7]:4711\", for=10.0.0.1"), "2001:db8::7");
  EXPECT_EQ(of("for=6.6.6.6, for=203.0.113.9"), "203.0.113.9");
  for (const char* nobody :
       {"for=_hidden", "for=unknown", "proto=https", "203.0.113.9", "for=", "for=\"\"", "for=\"",
        "for=\"203.0.113.9", "for=;for=203.0.113.9", "for =203.0.113.9", ";", "for", ";;for",
        "for=\"_x\"", "for=\"[::1]x\""})
    EXPECT_EQ(of(nobody), kSender) << nobody;
}

/// A head that names `address`, with `more` bytes behind the addresses.
std::vector<std::uint8_t> headFor(const std::string& address, std::size_t more = 0) {
  std::vector<std::uint8_t> out = {0x0D, 0x0A, 0x0D, 0x0A, 0x00, 0x0D, 0x0A,
                                   0x51, 0x55, 0x49, 0x54, 0x0A, 0x21};
  const ip::address of = ip::make_address(address);
  const std::size_t length = (of.is_v4() ? 12 : 36) + more;
  out.push_back(of.is_v4() ? 0x11 : 0x21);
  out.push_back(static_cast<std::uint8_t>(length >> 8));
  out.push_back(static_cast<std::uint8_t>(length));
  if (of.is_v4())
    for (const std::uint8_t byte : of.to_v4().to_bytes()) out.push_back(byte);
  else
    for (const std::uint8_t byte : of.to_v6().to_bytes()) out.push_back(byte);
  out.resize(16 + length);
  return out;
}

TEST(TrustedProxies, theProxyProtocolsHeadIsReadOnceItIsWhole) {
  for (const std::string& address : {std::string("203.0.113.9"), std::string("2001:db8::7")})
    for (const std::size_t more : {0, 7, 300}) {
      const auto bytes = headFor(address, more);
      for (std::size_t n = 0; n < bytes.size(); ++n)
        EXPECT_EQ(readProxyHead(std::span(bytes).first(n)).state, ProxyHead::State::kIncomplete);
      auto longer = bytes;
      longer.push_back('G');
      for (const auto& some : {bytes, longer}) {
        const ProxyHead head = readProxyHead(some);
        EXPECT_EQ(head.state, ProxyHead::State::kWhole);
        EXPECT_EQ(head.bytes, bytes.size());
        ASSERT_TRUE(head.client);
        EXPECT_EQ(head.client->to_string(), address);
      }
    }
  auto local = headFor("203.0.113.9");
  local[12] = 0x20;
  EXPECT_EQ(readProxyHead(local).state, ProxyHead::State::kWhole);
  EXPECT_FALSE(readProxyHead(local).client) << "the proxy asks for itself";
}

TEST(TrustedProxies, aHeadHasAtMost4096Bytes) {
  for (const std::string& address : {std::string("203.0.113.9"), std::string("2001:db8::7")})
    for (const std::size_t bytes : {4095, 4096, 4097}) {
      const auto whole = headFor(address, bytes - headFor(address).size());
      ASSERT_EQ(whole.size(), bytes);
      using State = ProxyHead::State;
      EXPECT_EQ(readProxyHead(whole).state, bytes <= 4096 ? State::kWhole : State::kWrong) << bytes;
      EXPECT_EQ(readProxyHead(std::span(whole).first(16)).state,
                bytes <= 4096 ? State::kIncomplete : State::kWrong)
          << bytes << ", which its first 16 tell";
    }
}

TEST(TrustedProxies, whatIsNoHeadOfTheProxyProtocolIsTold) {
  for (const std::size_t at : {0, 5, 11, 12}) {
    auto bytes = headFor("203.0.113.9");
    bytes[at] ^= 0x40;
    EXPECT_EQ(readProxyHead(bytes).state, ProxyHead::State::kWrong) << at;
  }
  auto tooShort = headFor("203.0.113.9");
  tooShort[15] = 11;
  EXPECT_EQ(readProxyHead(tooShort).state, ProxyHead::State::kWrong);
  auto tooLong = headFor("203.0.113.9");
  tooLong[14] = 0xFF;
  EXPECT_EQ(readProxyHead(tooLong).state, ProxyHead::State::kWrong);
  const std::string request = "GET / HTTP/1.1\r\n";
  EXPECT_EQ(
      readProxyHead(std::span(reinterpret_cast<const std::uint8_t*>(request.data()), 4)).state,
      ProxyHead::State::kWrong)
      << "at once, and not when sixteen bytes have come";
  std::mt19937 random(1);
  for (int i = 0; i < 20'000; ++i) {
    auto bytes = headFor("2001:db8::7", random() % 50);
    for (int k = 0; k < 3; ++k)
      bytes[random() % bytes.size()] = static_cast<std::uint8_t>(random());
    bytes.resize(random() % (bytes.size() + 1));
    const ProxyHead head = readProxyHead(bytes);
    EXPECT_TRUE(head.state != ProxyHead::State::kWhole || head.bytes <= bytes.size());
  }
}

}  // namespace
}  // namespace qtet
