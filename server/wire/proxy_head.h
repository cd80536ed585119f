// The head of the PROXY protocol, version 2, which a proxy sends before anything else.
#pragma once

#include <utility>  // before any Asio header: 1.74 uses std::exchange without it

#include <boost/asio/ip/address.hpp>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace qtet {

/// The head of the PROXY protocol, version 2, as far as it has arrived.
struct ProxyHead {
  enum class State : std::uint8_t {
    kIncomplete,  ///< more bytes are needed
    kWrong,       ///< it is none
    kWhole,
  };
  State state = State::kIncomplete;
  /// The head's size if it is whole: take so many bytes from the connection.
  std::size_t bytes = 0;
  /// nullopt: the proxy speaks for itself (LOCAL), or for a client without an IP address.
  std::optional<boost::asio::ip::address> client{};
};

/// A head has at most this many bytes: 16, the addresses, and additions of proxies about TLS.
inline constexpr std::size_t kMaxProxyHeadBytes = 4096;

/// Reads the first bytes of a connection ("The PROXY protocol", haproxy.org, section 2.2).
[[nodiscard]] ProxyHead readProxyHead(std::span<const std::uint8_t> bytes);

}  // namespace qtet
