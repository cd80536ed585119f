#include "server/session/http_input.h"

#include <algorithm>
#include <array>
#include <limits>

#include "server/http/deadline.h"
#include "server/wire/http_gate.h"
#include "server/wire/http_limits.h"

namespace qtet {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
using beast::error_code;

constexpr std::size_t kReadBytes = 4096;

Reply tooLong() {
  return problem(431, "header-too-large",
                 "at most " + std::to_string(limits::kMaxHeaderBytes) + " bytes and " +
                     std::to_string(limits::kMaxHeaderLines) + " lines of request head are read");
}

/// The answer to a head that Beast's parser does not take.
Reply answerToParseError(const error_code& ec) {
  if (ec == http::error::header_limit || ec == http::error::buffer_overflow) return tooLong();
  if (ec == http::error::bad_version)
    return problem(505, "version-not-supported", "this server speaks HTTP/1.1 and HTTP/1.0");
  return problem(400, "bad-request", "this is not HTTP: " + ec.message());
}

/// The answer to bytes that are no head, or not yet; nullopt: more of it may come.
std::optional<Reply> gateRefusal(HttpGate::Verdict verdict, std::size_t bytes) {
  if (verdict == HttpGate::Verdict::kTooLong || bytes >= limits::kMaxHeaderBytes) return tooLong();
  if (verdict != HttpGate::Verdict::kBroken) return std::nullopt;
  return problem(
      400, "bad-request",
      "this is not HTTP/1.1: a bare line end, a control byte, a folded line or no method");
}

}  // namespace

void HttpInput::readSome(error_code& ec, std::size_t max) {
  std::array<char, kReadBytes> bytes;
  const std::size_t count =
      peer_.socket.read(std::span(bytes).first(std::min(max, bytes.size())), ec);
  buffer_.commit(asio::buffer_copy(buffer_.prepare(count), asio::buffer(bytes, count)));
}

asio::awaitable<HttpInput::Begun> HttpInput::waitForRequest() {
  Begun out = Begun::kAtOnce;
  buffer_.consume(emptyLinesBefore(buffered()));
  while (buffer_.size() == 0) {
    if (peer_.connection->ending()) co_return Begun::kNot;
    error_code ec;
    readSome(ec, kReadBytes);
    if (ec == asio::error::would_block) {
      buffer_ = beast::flat_buffer(limits::kMaxHeaderBytes);  // a silent client has none
      idleTimer_.begin(timeouts_.idle);
      const IdleScope idle(peer_);
      ec = co_await peer_.socket.waitToRead();
      idleTimer_.stop();
      out = Begun::kWaited;
    }
    if (ec) co_return Begun::kNot;
    buffer_.consume(emptyLinesBefore(buffered()));
  }
  co_return out;
}

asio::awaitable<std::expected<void, std::optional<Reply>>> HttpInput::readHead(Parser& parser) {
  HttpGate gate;
  std::optional<Deadline> deadline;  // most heads come in one piece
  for (;;) {
    const HttpGate::Verdict verdict = gate.look(buffered());
    if (verdict == HttpGate::Verdict::kComplete) break;
    if (std::optional<Reply> refusal = gateRefusal(verdict, buffer_.size()))
      co_return std::unexpected(std::move(refusal));
    error_code ec;
    if (!deadline) deadline.emplace(peer_.socket, timeouts_.header);
    if (!deadline->passed()) {
      readSome(ec, limits::kMaxHeaderBytes - buffer_.size());
      if (ec == asio::error::would_block) ec = co_await peer_.socket.waitToRead();
    }
    if (deadline->passed())
      co_return std::unexpected(
          problem(408, "request-timeout", "the request's head did not arrive in time"));
    if (ec) co_return std::unexpected(std::nullopt);
  }
  parser.header_limit(limits::kMaxHeaderBytes);
  // Bodies are the router's business. Not boost::none: Beast 1.74 then refuses a length of 0, too.
  parser.body_limit(std::numeric_limits<std::uint64_t>::max());
  error_code ec;
  parser.put(asio::buffer(buffered().data(), gate.headBytes()), ec);
  if (ec || !parser.is_header_done()) co_return std::unexpected(answerToParseError(ec));
  buffer_.consume(gate.headBytes());
  co_return std::expected<void, std::optional<Reply>>();
}

asio::awaitable<std::size_t> HttpInput::readBody(std::span<std::uint8_t> into) {
  std::size_t have = std::min(buffer_.size(), into.size());
  std::copy_n(buffered().data(), have, into.begin());
  buffer_.consume(have);
  error_code ec;
  const Deadline deadline(peer_.socket, timeouts_.body);
  while (have < into.size() && !ec && !deadline.passed()) {
    have +=
        peer_.socket.read({reinterpret_cast<char*>(into.data()) + have, into.size() - have}, ec);
    if (ec == asio::error::would_block) ec = co_await peer_.socket.waitToRead();
  }
  bodyBytes_ += have;
  co_return have;
}

asio::awaitable<void> HttpInput::drain() {
  const Deadline deadline(peer_.socket, limits::kLingerTime);
  error_code ec;
  std::size_t read = buffer_.size();
  while (!ec && read < limits::kLingerBytes && !deadline.passed()) {
    buffer_.clear();
    readSome(ec, limits::kLingerBytes - read);
    read += buffer_.size();
    if (ec == asio::error::would_block) ec = co_await peer_.socket.waitToRead();
  }
}

}  // namespace qtet
