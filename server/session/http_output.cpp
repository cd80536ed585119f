#include "server/session/http_output.h"

#include <algorithm>
#include <array>
#include <boost/asio/error.hpp>
#include <cassert>
#include <span>

#include "server/http/deadline.h"
#include "server/wire/http_limits.h"

namespace qtet {
namespace {

namespace asio = boost::asio;
using boost::system::error_code;

/// Writes as much as the socket accepts in one call. That is the head with the first bytes of the
/// body, or a part of the body alone.
std::size_t writeSome(ClientSocket& socket, const OutgoingReply& reply, bool headWaits,
                      error_code& ec) {
  const auto& [head, bodyInHead, body, file] = reply;
  if (head.empty() && file)
    return socket.writeFile(*file, body.first(std::min(body.size(), limits::kMaxFromFile)), ec);
  const std::array<iovec, 2> parts = {
      iovec{const_cast<char*>(head.data()), head.size()},
      iovec{const_cast<std::uint8_t*>(body.data()), std::min(body.size(), limits::kWritePiece)}};
  const std::size_t first = head.empty() ? 1 : 0, count = file || head.empty() ? 1 : 2;
  return socket.write(std::span(parts).subspan(first, count), headWaits, ec);
}

}  // namespace

asio::awaitable<Sent> sendReply(ClientSocket& socket, OutgoingReply reply,
                                std::chrono::milliseconds patience, bool unpaced) {
  Sent out;
  assert(reply.bodyInHead <= reply.head.size());
  const std::size_t headBytes = reply.head.size() - reply.bodyInHead;
  std::size_t sent = 0;
  // The head goes with the first bytes, except before a large body for a client on this machine.
  // There its own packet costs less than misaligning all further packets.
  const bool headWaits = reply.file && !(unpaced && reply.body.size() >= limits::kMaxFromFile);
  std::optional<Deadline> deadline;  // for a piece; most answers are taken at once
  for (std::size_t taken = 0; !reply.head.empty() || !reply.body.empty();) {
    error_code ec;
    const std::size_t count = writeSome(socket, reply, headWaits, ec);
    assert(count <= reply.head.size() + reply.body.size());
    const std::size_t ofHead = std::min(count, reply.head.size());
    reply.head.remove_prefix(ofHead);
    reply.body = reply.body.subspan(count - ofHead);
    if (reply.file) reply.file->offset += count - ofHead;
    sent += count;
    taken += count;
    if (deadline && taken >= limits::kWritePiece) deadline.reset(), taken = 0;
    if (ec == asio::error::would_block) {
      if (!deadline) deadline.emplace(socket, patience), taken = 0;
      ec = deadline->passed() ? asio::error::timed_out : co_await socket.waitToWrite();
    }
    out.bytes = sent - std::min(sent, headBytes);
    if (ec) co_return out;
  }
  out.whole = true;
  co_return out;
}

}  // namespace qtet
