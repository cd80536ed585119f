// Takes a client's HTTP heads and bodies out of the bytes that have arrived.
#pragma once

#include <utility>  // before any Asio header: 1.74 uses std::exchange without it

#include <boost/asio/awaitable.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/parser.hpp>
#include <cstdint>
#include <expected>
#include <optional>
#include <span>
#include <string_view>

#include "server/http/http_message.h"
#include "server/http/idle_timer.h"
#include "server/session/services.h"
#include "server/wire/http_limits.h"
#include "server/wire/peer.h"

namespace qtet {

/// Holds the bytes that were read and not taken yet; a silent client has none. Both references
/// outlive it.
class HttpInput {
 public:
  using Parser = boost::beast::http::request_parser<boost::beast::http::empty_body>;

  HttpInput(Peer& peer, const Timeouts& timeouts)
      : peer_(peer),
        timeouts_(timeouts),
        idleTimer_(peer.socket),
        buffer_(limits::kMaxHeaderBytes) {}

  enum class Begun : std::uint8_t {
    kNot,     ///< the client has gone or said nothing for too long, or the server ends
    kAtOnce,  ///< its first byte had come before
    kWaited,  ///< others had their turn meanwhile
  };
  /// Waits for the first byte of a request.
  boost::asio::awaitable<Begun> waitForRequest();
  /// Has the whole head parsed. Else what is answered, and the connection ends; nullopt: the client
  /// has gone. Such a head stays buffered(), as far as it came.
  boost::asio::awaitable<std::expected<void, std::optional<Reply>>> readHead(Parser& parser);
  /// Fills `into` with what follows the head. Bytes read; fewer: they did not come, or not in time.
  boost::asio::awaitable<std::size_t> readBody(std::span<std::uint8_t> into);
  /// The bytes that readBody() has read since the last call.
  [[nodiscard]] std::uint64_t takeBodyBytes() { return std::exchange(bodyBytes_, 0); }
  /// Reads and discards the client's further bytes, within bounds. Closing with unread bytes would
  /// reset the connection, and the answer might be lost on its way.
  boost::asio::awaitable<void> drain();
  /// The bytes that were read and not taken: those beyond the last head.
  [[nodiscard]] std::string_view buffered() const {
    return {static_cast<const char*>(buffer_.data().data()), buffer_.size()};
  }

 private:
  /// Reads the bytes that have arrived, without waiting.
  void readSome(boost::beast::error_code& ec, std::size_t max);

  Peer& peer_;
  const Timeouts& timeouts_;
  IdleTimer idleTimer_;
  boost::beast::flat_buffer buffer_;
  std::uint64_t bodyBytes_ = 0;
};

}  // namespace qtet
