#include "server/http_session.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <array>
#include <boost/asio/async_result.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/redirect_error.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/read.hpp>
#include <limits>
#include <optional>

#include "server/http_request.h"
#include "server/limits.h"
#include "server/stream_session.h"

namespace qtet {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
using asio::redirect_error;
using asio::use_awaitable;
using beast::error_code;

constexpr std::size_t kReadBytes = 4096;

bool isHttpError(const error_code& ec) { return ec.category() == http::make_error_code(http::error::end_of_stream).category(); }

/// The answer to a head that could not be read; nullopt when nobody waits for one.
std::optional<Reply> answerToReadError(const error_code& ec) {
  if (ec == beast::error::timeout) return problem(408, "request-timeout", "the request's head did not arrive in time");
  if (ec == http::error::header_limit || ec == http::error::buffer_overflow)
    return problem(431, "header-too-large", "at most " + std::to_string(limits::kMaxHeaderBytes) + " bytes of request head are read");
  if (ec == http::error::bad_version) return problem(505, "version-not-supported", "this server speaks HTTP/1.1 and HTTP/1.0");
  if (ec == http::error::end_of_stream || ec == http::error::partial_message || !isHttpError(ec)) return std::nullopt;
  return problem(400, "bad-request", "this is not HTTP: " + ec.message());
}

class HttpSession {
 public:
  HttpSession(beast::tcp_stream stream, const Services& services, std::shared_ptr<Connection> connection)
      : stream_(std::move(stream)), services_(services), connection_(std::move(connection)), buffer_(limits::kMaxHeaderBytes) {
    connection_->onEnd([this] {
      if (idle_) stream_.cancel();
    });
  }
  ~HttpSession() {
    if (connection_) connection_->onEnd({});
  }
  HttpSession(const HttpSession&) = delete;
  HttpSession& operator=(const HttpSession&) = delete;

  asio::awaitable<void> run();

 private:
  asio::awaitable<bool> waitForBytes();
  /// Answers one request; false: the connection is not to be used further.
  asio::awaitable<bool> answer(const http::request<http::empty_body>& request);
  asio::awaitable<bool> answerLevel(Reply reply, bool keepAlive);
  asio::awaitable<Result<Bytes>> makeLevelElsewhere(LevelRequest level);
  asio::awaitable<bool> send(const Reply& reply, bool keepAlive);
  asio::awaitable<void> refuse(Reply reply);
  asio::awaitable<void> linger();

  beast::tcp_stream stream_;
  const Services& services_;
  std::shared_ptr<Connection> connection_;
  beast::flat_buffer buffer_;
  bool idle_ = false;  // waits for a request that has not begun
};

asio::awaitable<bool> HttpSession::waitForBytes() {
  if (buffer_.size() > 0) co_return true;
  if (connection_->ending()) co_return false;
  error_code ec;
  stream_.expires_after(limits::kIdleTime);
  idle_ = true;
  const std::size_t n = co_await stream_.async_read_some(buffer_.prepare(kReadBytes), redirect_error(use_awaitable, ec));
  idle_ = false;
  buffer_.commit(n);
  co_return !ec;
}

asio::awaitable<void> HttpSession::run() {
  for (;;) {
    const bool begun = co_await waitForBytes();
    if (!begun) co_return;
    http::request_parser<http::empty_body> parser;
    parser.header_limit(limits::kMaxHeaderBytes);
    // Bodies are refused by their headers. Not boost::none: Beast 1.74 then refuses a length of 0, too.
    parser.body_limit(std::numeric_limits<std::uint64_t>::max());
    error_code ec;
    stream_.expires_after(limits::kHeaderTime);
    co_await http::async_read_header(stream_, buffer_, parser, redirect_error(use_awaitable, ec));
    if (ec) {
      std::optional<Reply> reply = answerToReadError(ec);
      if (reply) co_await refuse(std::move(*reply));
      co_return;
    }
    std::optional<Reply> refusal = refusalOf(parser.get());
    if (!refusal && isStreamHandshake(parser.get())) {
      refusal = handshakeRefusal(parser.get());
      if (!refusal) {
        connection_->onEnd({});
        stream_.expires_never();  // a WebSocket keeps its own time
        co_await serveStream(std::move(stream_), parser.release(), services_.store, connection_);
        co_return;
      }
    }
    if (refusal) {
      co_await refuse(std::move(*refusal));
      co_return;
    }
    const bool again = co_await answer(parser.get());
    if (!again) co_return;
  }
}

asio::awaitable<bool> HttpSession::answer(const http::request<http::empty_body>& request) {
  Reply reply = services_.router.route(viewOf(request));
  const bool keepAlive = request.keep_alive() && !reply.close;
  bool sent = false;
  if (std::holds_alternative<LevelRequest>(reply.body) && reply.sendBody) {
    sent = co_await answerLevel(std::move(reply), keepAlive);
  } else {
    sent = co_await send(reply, keepAlive);
  }
  co_return sent;
}

asio::awaitable<bool> HttpSession::answerLevel(Reply reply, bool keepAlive) {
  const LevelJobs::Place place = services_.jobs.reserve();  // until it was sent
  if (!place) {
    Reply busy = problem(503, "busy", "too many levels are being made; try again");
    busy.headers.emplace_back("Retry-After", std::to_string(limits::kRetryAfterSeconds));
    co_return co_await send(busy, keepAlive);
  }
  const LevelRequest level = std::get<LevelRequest>(reply.body);
  const Result<Bytes> bytes = co_await makeLevelElsewhere(level);
  if (!bytes) {
    spdlog::error("{}: level {} cannot be made: {}", level.mesh->id, level.level, bytes.error().text());
    const Reply failed = problem(500, "internal", "the level cannot be made: " + bytes.error().text());
    co_return co_await send(failed, keepAlive);
  }
  reply.body = ByteView(*bytes);
  co_return co_await send(reply, keepAlive);
}

asio::awaitable<Result<Bytes>> HttpSession::makeLevelElsewhere(LevelRequest level) {
  auto executor = stream_.get_executor();
  auto start = [this, executor, level](auto handler) {
    services_.jobs.submit(level, [executor, handler = std::move(handler)](Result<Bytes> bytes) mutable {
      // Back to the connection's own executor: a coroutine must not go on in the pool.
      asio::post(executor, [handler = std::move(handler), bytes = std::move(bytes)]() mutable { handler(std::move(bytes)); });
    });
  };
  co_return co_await asio::async_initiate<const asio::use_awaitable_t<>, void(Result<Bytes>)>(std::move(start), use_awaitable);
}

asio::awaitable<bool> HttpSession::send(const Reply& reply, bool keepAlive) {
  keepAlive = keepAlive && !connection_->ending();
  const std::string head = headerText(reply, keepAlive);
  ByteView body;
  if (const auto* text = std::get_if<std::string>(&reply.body)) body = {reinterpret_cast<const std::uint8_t*>(text->data()), text->size()};
  if (const auto* view = std::get_if<ByteView>(&reply.body)) body = *view;
  if (!reply.sendBody) body = {};

  asio::const_buffer first = asio::buffer(head);
  do {
    const ByteView piece = body.first(std::min(body.size(), limits::kWritePiece));
    body = body.subspan(piece.size());
    const std::array<asio::const_buffer, 2> buffers = {first, asio::const_buffer(piece.data(), piece.size())};
    error_code ec;
    stream_.expires_after(limits::kWriteTime);
    co_await asio::async_write(stream_, buffers, redirect_error(use_awaitable, ec));
    if (ec) co_return false;
    first = {};
  } while (!body.empty());
  if (!keepAlive) co_await linger();
  co_return keepAlive;
}

asio::awaitable<void> HttpSession::refuse(Reply reply) {
  reply.close = true;
  co_await send(reply, false);
}

/// Closing while bytes of the client's lie unread would reset the connection, and the answer might be lost on its way.
asio::awaitable<void> HttpSession::linger() {
  error_code ec;
  stream_.socket().shutdown(asio::ip::tcp::socket::shutdown_send, ec);
  stream_.expires_after(limits::kLingerTime);
  std::array<char, kReadBytes> scrap;
  for (std::size_t read = 0; !ec && read < limits::kLingerBytes;)
    read += co_await stream_.async_read_some(asio::buffer(scrap), redirect_error(use_awaitable, ec));
}

}  // namespace

asio::awaitable<void> serveHttp(beast::tcp_stream stream, const Services& services, std::shared_ptr<Connection> connection) {
  HttpSession session(std::move(stream), services, std::move(connection));
  co_await session.run();
}

}  // namespace qtet
