#include <utility>  // before any Asio header: 1.74 uses std::exchange without it

#include "server/wire/trusted_proxies.h"

#include <algorithm>
#include <boost/asio/ip/address.hpp>
#include <boost/asio/ip/network_v4.hpp>
#include <boost/asio/ip/network_v6.hpp>
#include <boost/system/error_code.hpp>
#include <string>
#include <vector>

#include "server/wire/blanks.h"

namespace qtet {
namespace {

namespace ip = boost::asio::ip;
using boost::system::error_code;

/// A port, or what stands for one in RFC 7239: "4711", "_hidden".
bool isPort(std::string_view text) {
  constexpr std::string_view kDigits = "0123456789";
  constexpr std::size_t kMaxDigits = 5;  // 65535
  if (text.starts_with('_')) return text.size() > 1;
  return !text.empty() && text.size() <= kMaxDigits &&
         text.find_first_not_of(kDigits) == std::string_view::npos;
}

/// "192.0.2.1", "192.0.2.1:4711", "2001:db8::1", "[2001:db8::1]:4711".
std::optional<ip::address> addressOf(std::string_view text) {
  std::string_view behind;
  const bool bracketed = text.starts_with('[');
  if (bracketed) {
    const std::size_t close = text.find(']');
    if (close == std::string_view::npos) return std::nullopt;
    behind = text.substr(close + 1);
    text = text.substr(1, close - 1);
  } else if (std::ranges::count(text, ':') == 1) {
    behind = text.substr(text.find(':'));
    text = text.substr(0, text.find(':'));
  }
  if (!behind.empty() && (behind.front() != ':' || !isPort(behind.substr(1)))) return std::nullopt;
  // A zone would be another machine's.
  if (text.find('%') != std::string_view::npos) return std::nullopt;
  error_code ec;
  const ip::address out = ip::make_address(std::string(text), ec);
  if (ec || (bracketed && out.is_v4())) return std::nullopt;
  return plainAddress(out);
}

/// The value of `for` in an element of Forwarded, such as `for="[2001:db8::1]:4711";proto=https`.
std::string_view forOf(std::string_view element) {
  while (!element.empty()) {
    const std::size_t end = std::min(element.find(';'), element.size());
    const std::string_view pair = trimmed(element.substr(0, end), kHeaderBlanks);
    element.remove_prefix(std::min(end + 1, element.size()));
    if (pair.find('=') != 3 || !std::ranges::equal(pair.substr(0, 3), std::string_view("for"), {},
                                                   [](char c) { return c | 0x20; }))
      continue;
    std::string_view value = pair.substr(4);
    if (value.size() >= 2 && value.starts_with('"') && value.ends_with('"'))
      value = value.substr(1, value.size() - 2);
    return value;
  }
  return {};
}

std::optional<ip::network_v6> network6(const ip::address_v6& address, unsigned bits) {
  if (bits > 128) return std::nullopt;
  return ip::network_v6(address, static_cast<unsigned short>(bits)).canonical();
}

std::optional<unsigned> bitsOf(std::string_view text) {
  if (text.empty() || text.size() > 3 ||
      text.find_first_not_of("0123456789") != std::string_view::npos)
    return std::nullopt;
  unsigned out = 0;
  for (const char c : text) out = 10 * out + static_cast<unsigned>(c - '0');
  return out;
}

}  // namespace

struct Networks::Blocks {
  std::vector<ip::network_v4> v4;
  std::vector<ip::network_v6> v6;
};

ip::address plainAddress(const ip::address& address) {
  if (!address.is_v6() || !address.to_v6().is_v4_mapped()) return address;
  return ip::make_address_v4(ip::v4_mapped, address.to_v6());
}

Result<Networks> Networks::parse(std::string_view list) {
  Blocks blocks;
  while (!list.empty()) {
    const std::size_t end = std::min(list.find(','), list.size());
    const std::string_view one = trimmed(list.substr(0, end), kHeaderBlanks);
    list.remove_prefix(std::min(end + 1, list.size()));
    const auto refused = [&] {
      return fail(ErrorCode::kBadValue, "'" + std::string(one) +
                                            "' is no address and no block of addresses, like "
                                            "10.0.0.0/8 or 2001:db8::/32");
    };
    const std::size_t slash = std::min(one.find('/'), one.size());
    error_code ec;
    const ip::address address = ip::make_address(std::string(one.substr(0, slash)), ec);
    if (ec) return refused();
    const auto bits = slash == one.size() ? std::optional<unsigned>(address.is_v4() ? 32 : 128)
                                          : bitsOf(one.substr(slash + 1));
    if (!bits) return refused();
    if (address.is_v4()) {
      if (*bits > 32) return refused();
      blocks.v4.push_back(
          ip::network_v4(address.to_v4(), static_cast<unsigned short>(*bits)).canonical());
    } else if (const auto network = network6(address.to_v6(), *bits)) {
      blocks.v6.push_back(*network);
    } else {
      return refused();
    }
  }
  Networks out;
  if (!blocks.v4.empty() || !blocks.v6.empty())
    out.blocks_ = std::make_shared<const Blocks>(std::move(blocks));
  return out;
}

bool Networks::contains(const ip::address& address) const {
  if (!blocks_) return false;
  const ip::address one = plainAddress(address);
  if (one.is_v4())
    return std::ranges::any_of(blocks_->v4, [&](const ip::network_v4& network) {
      return ip::network_v4(one.to_v4(), network.prefix_length()).canonical() == network;
    });
  return std::ranges::any_of(blocks_->v6, [&](const ip::network_v6& network) {
    return ip::network_v6(one.to_v6(), network.prefix_length()).canonical() == network;
  });
}

ip::address forwardedClient(const TrustedProxies& proxies, const ip::address& sender,
                            std::string_view value) {
  ip::address last = plainAddress(sender);
  for (bool more = true; more;) {
    const std::size_t comma = value.rfind(',');
    more = comma != std::string_view::npos;
    std::string_view one = trimmed(more ? value.substr(comma + 1) : value, kHeaderBlanks);
    value = value.substr(0, more ? comma : 0);
    if (proxies.header == ProxyHeader::kForwarded) one = forOf(one);
    const std::optional<ip::address> address = addressOf(one);
    if (!address) return last;  // nobody before it can be believed
    last = *address;
    if (!proxies.networks.contains(last)) return last;
  }
  return last;
}

}  // namespace qtet
