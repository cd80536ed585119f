// Sending an answer's head and body over a socket that never blocks.
#pragma once

#include <utility>  // before any Asio header: 1.74 uses std::exchange without it

#include <boost/asio/awaitable.hpp>
#include <chrono>
#include <cstdint>
#include <optional>
#include <string_view>

#include "proto/bytes.h"
#include "server/wire/client_socket.h"
#include "server/wire/file_part.h"

namespace qtet {

/// A reply to send; all of it outlives the call.
struct OutgoingReply {
  std::string_view head{};
  std::size_t bodyInHead = 0;      ///< bytes at the end of `head` that are the body's
  ByteView body{};                 ///< what of it comes behind them
  std::optional<FilePart> file{};  ///< where the body stands as well: it is sent from there
};

/// How much of a body went out.
struct Sent {
  std::uint64_t bytes = 0;
  bool whole = false;  ///< the head and all of the body
};

/// Until all is taken, the connection breaks, or the client takes less than limits::kWritePiece in
/// `patience`. `unpaced`: as Services has it.
boost::asio::awaitable<Sent> sendReply(ClientSocket& socket, OutgoingReply reply,
                                       std::chrono::milliseconds patience, bool unpaced);

}  // namespace qtet
