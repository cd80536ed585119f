#include "server/stream_session.h"

#include <array>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/redirect_error.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/websocket/stream.hpp>
#include <exception>

#include "server/limits.h"
#include "server/stream_protocol.h"

namespace qtet {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using asio::redirect_error;
using asio::use_awaitable;
using beast::error_code;

/// A reader and a writer on one executor. The writer alone writes and closes; the reader wakes it when a message has changed what is to
/// be said. Both hold the session, so it ends with the later of the two.
class StreamSession : public std::enable_shared_from_this<StreamSession> {
 public:
  StreamSession(beast::tcp_stream stream, const MeshStore& store, std::shared_ptr<Connection> connection)
      : socket_(std::move(stream)), wake_(socket_.get_executor()), protocol_(store), connection_(std::move(connection)) {}

  asio::awaitable<bool> accept(const http::request<http::empty_body>& request);
  asio::awaitable<void> read();
  asio::awaitable<void> write();
  /// Ends the session by the server's own fault.
  void fail() {
    failed_ = true;
    wake_.cancel();
  }

 private:
  asio::awaitable<void> waitForNews();
  asio::awaitable<void> send(Outgoing outgoing);
  void configure();

  websocket::stream<beast::tcp_stream> socket_;
  asio::steady_timer wake_;
  StreamProtocol protocol_;
  std::shared_ptr<Connection> connection_;
  bool ended_ = false;    // nothing can be written any more
  bool closing_ = false;  // the writer closes the socket
  bool failed_ = false;   // the reader threw
};

void StreamSession::configure() {
  socket_.set_option(websocket::stream_base::timeout{limits::kHandshakeTime, limits::kSilenceTime, true});
  socket_.set_option(websocket::stream_base::decorator([](websocket::response_type& response) {
    response.set(http::field::sec_websocket_protocol, beast::string_view(kStreamSubprotocol.data(), kStreamSubprotocol.size()));
    response.set(http::field::server, "qtet-server/" QTET_VERSION);
  }));
  socket_.read_message_max(kMaxMessageBytes);
  socket_.auto_fragment(false);  // a frame is one piece of the mapping; splitting it would copy it
}

asio::awaitable<bool> StreamSession::accept(const http::request<http::empty_body>& request) {
  configure();
  error_code ec;
  co_await socket_.async_accept(request, redirect_error(use_awaitable, ec));
  co_return !ec;
}

asio::awaitable<void> StreamSession::read() {
  beast::flat_buffer buffer;
  for (;;) {
    error_code ec;
    co_await socket_.async_read(buffer, redirect_error(use_awaitable, ec));
    if (ec) break;
    if (socket_.got_binary()) {
      protocol_.receiveBinary();
    } else {
      protocol_.receive({static_cast<const char*>(buffer.data().data()), buffer.size()}, StreamProtocol::Clock::now());
    }
    buffer.consume(buffer.size());
    wake_.cancel();
  }
  ended_ = true;
  // A write may wait for a client that has gone; a closing handshake ends by itself.
  if (!closing_) beast::get_lowest_layer(socket_).close();
  wake_.cancel();
}

asio::awaitable<void> StreamSession::write() {
  connection_->onEnd([this] { wake_.cancel(); });
  while (!ended_ && !closing_) {
    std::optional<Outgoing> outgoing;
    if (failed_) {
      outgoing = CloseCode::kInternal;
    } else if (connection_->ending()) {
      outgoing = CloseCode::kGoingAway;
    } else {
      outgoing = protocol_.next();
    }
    if (outgoing) {
      co_await send(std::move(*outgoing));
    } else {
      co_await waitForNews();
    }
  }
  connection_->onEnd({});
}

/// One executor runs reader, writer and the server's end, so nothing can happen between the writer's last look and this wait.
asio::awaitable<void> StreamSession::waitForNews() {
  error_code ec;
  wake_.expires_at(asio::steady_timer::time_point::max());
  co_await wake_.async_wait(redirect_error(use_awaitable, ec));
}

asio::awaitable<void> StreamSession::send(Outgoing outgoing) {
  error_code ec;
  if (const auto* text = std::get_if<std::string>(&outgoing)) {
    socket_.text(true);
    co_await socket_.async_write(asio::buffer(*text), redirect_error(use_awaitable, ec));
  } else if (const auto* frame = std::get_if<OutgoingFrame>(&outgoing)) {
    const auto header = frame->header.encode();
    const std::array<asio::const_buffer, 2> buffers = {asio::buffer(header),
                                                       asio::const_buffer(frame->payload.data(), frame->payload.size())};
    socket_.binary(true);
    co_await socket_.async_write(buffers, redirect_error(use_awaitable, ec));
  } else {
    closing_ = true;
    const auto code = static_cast<std::uint16_t>(std::get<CloseCode>(outgoing));
    co_await socket_.async_close(websocket::close_reason(code), redirect_error(use_awaitable, ec));
  }
  if (ec && !closing_) {
    ended_ = true;
    beast::get_lowest_layer(socket_).close();  // the reader ends, too
  }
}

}  // namespace

asio::awaitable<void> serveStream(beast::tcp_stream stream, http::request<http::empty_body> request, const MeshStore& store,
                                  std::shared_ptr<Connection> connection) {
  const auto session = std::make_shared<StreamSession>(std::move(stream), store, std::move(connection));
  const bool accepted = co_await session->accept(request);
  if (!accepted) co_return;
  const auto executor = co_await asio::this_coro::executor;
  const auto readerEnded = [session](const std::exception_ptr& thrown) {
    if (thrown) session->fail();
  };
  asio::co_spawn(
      executor, [session]() -> asio::awaitable<void> { return session->read(); }, readerEnded);
  co_await session->write();
}

}  // namespace qtet
