// Proxies in front of the server, which alone may say for whom they ask.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string_view>

#include "proto/error.h"

namespace boost::asio::ip {
class address;  // NOLINT(readability-identifier-naming): as Asio calls it
}

namespace qtet {

/// Blocks of addresses, as CIDR writes them. Immutable.
class Networks {
 public:
  /// "10.0.0.0/8,2001:db8::/32,192.0.2.7": an address alone is a block of one. Errors: bad-value.
  [[nodiscard]] static Result<Networks> parse(std::string_view list);
  /// An IPv4 address that is written as IPv6 (::ffff:10.0.0.1) counts as what it is.
  [[nodiscard]] bool contains(const boost::asio::ip::address& address) const;
  [[nodiscard]] bool empty() const { return blocks_ == nullptr; }

 private:
  struct Blocks;
  std::shared_ptr<const Blocks> blocks_;  // nullptr: none
};

/// The header in which proxies report the client's address.
enum class ProxyHeader : std::uint8_t {
  kForwardedFor,   ///< X-Forwarded-For
  kForwarded,      ///< Forwarded (RFC 7239)
  kProxyProtocol,  ///< the PROXY protocol, version 2, before anything else on a connection
};

struct TrustedProxies {
  Networks networks;
  ProxyHeader header = ProxyHeader::kForwardedFor;
};

/// The client whose request the trusted proxy `sender` forwards. `value` is the header's whole
/// list. Each proxy appends the address that sent it the request, so the last address that is no
/// proxy's is the client's. Anybody may have written the part before it. Where a proxy names no
/// address, the request counts as its own.
[[nodiscard]] boost::asio::ip::address forwardedClient(const TrustedProxies& proxies,
                                                       const boost::asio::ip::address& sender,
                                                       std::string_view value);

/// An IPv4 address that is written as IPv6 becomes IPv4; any other stays as it is.
[[nodiscard]] boost::asio::ip::address plainAddress(const boost::asio::ip::address& address);

}  // namespace qtet
