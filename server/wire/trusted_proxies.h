// Proxies in front of the server, which alone may say for whom they ask.
#pragma once

#include <utility>  // before any Asio header: 1.74 uses std::exchange without it

#include <boost/asio/ip/address.hpp>
#include <boost/asio/ip/network_v4.hpp>
#include <boost/asio/ip/network_v6.hpp>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "proto/error.h"

namespace qtet {

/// Blocks of addresses, as CIDR writes them.
class Networks {
 public:
  /// "10.0.0.0/8,2001:db8::/32,192.0.2.7": an address alone is a block of one. Errors: bad-value.
  [[nodiscard]] static Result<Networks> parse(std::string_view list);
  /// An IPv4 address that is written as IPv6 (::ffff:10.0.0.1) counts as what it is.
  [[nodiscard]] bool contains(const boost::asio::ip::address& address) const;
  [[nodiscard]] bool empty() const { return v4_.empty() && v6_.empty(); }

 private:
  std::vector<boost::asio::ip::network_v4> v4_;
  std::vector<boost::asio::ip::network_v6> v6_;
};

/// How proxies tell the client's address.
enum class ProxyHeader : std::uint8_t {
  kForwardedFor,   ///< X-Forwarded-For
  kForwarded,      ///< Forwarded (RFC 7239)
  kProxyProtocol,  ///< the PROXY protocol, version 2, before anything else on a connection
};

struct TrustedProxies {
  Networks networks;
  ProxyHeader header = ProxyHeader::kForwardedFor;
};

/// Whose request a trusted proxy hands on. `value` is the header's whole list: each proxy adds at
/// its end from whom the request came, so the last address that is no proxy's is the client's;
/// what stands before it anybody may have written. Nothing: that place names no address.
[[nodiscard]] std::optional<boost::asio::ip::address> forwardedClient(const TrustedProxies& proxies,
                                                                      std::string_view value);

/// What has come of the head of the PROXY protocol, version 2.
struct ProxyHead {
  enum class State : std::uint8_t {
    kIncomplete,  ///< more bytes are needed
    kWrong,       ///< it is none
    kWhole,
  };
  State state = State::kIncomplete;
  /// Of the head, if it is whole: so many are to be taken from the connection.
  std::size_t bytes = 0;
  /// Nothing: the proxy speaks for itself (LOCAL), or for somebody without an IP address.
  std::optional<boost::asio::ip::address> client{};
};

/// A head has at most so many bytes: 16, the addresses, and what proxies add about TLS.
inline constexpr std::size_t kMaxProxyHeadBytes = 4096;

/// Reads the first bytes of a connection ("The PROXY protocol", haproxy.org, section 2.2).
[[nodiscard]] ProxyHead readProxyHead(std::span<const std::uint8_t> bytes);

}  // namespace qtet
