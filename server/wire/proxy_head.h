// The head of the PROXY protocol, version 2, which a proxy sends before anything else.
#pragma once

#include <utility>  // before any Asio header: 1.74 uses std::exchange without it

#include <boost/asio/ip/address.hpp>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace qtet {

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
