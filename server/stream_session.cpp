#include "server/stream_session.h"

#include <netinet/tcp.h>
#include <sys/socket.h>

#include <array>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/redirect_error.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <exception>
#include <optional>

#include "server/frame_gather.h"
#include "server/limits.h"
#include "server/stream_protocol.h"
#include "server/web_socket_reader.h"

namespace qtet {
namespace {

namespace asio = boost::asio;
using asio::redirect_error;
using asio::use_awaitable;
using asio::ip::tcp;
using boost::system::error_code;
using Clock = std::chrono::steady_clock;
using Event = WebSocketReader::Event;

/// On the stack of whoever reads, so that a silent client has no buffer.
constexpr std::size_t kReadBytes = 4096;
/// Bytes that the kernel may hold unsent: so a superseded order stops soon, and a stalled client costs little.
constexpr int kUnsentBytes = 96 << 10;
/// Before other connections of the thread have their turn.
constexpr int kReadsInARow = 8;

/// A reader, a writer and a clock on one executor. The writer alone writes, also pongs and closes, so that nothing comes between the parts of a
/// frame; the reader wakes it when there is something to say. All hold the session, so it ends with the last of them.
class StreamSession : public std::enable_shared_from_this<StreamSession> {
 public:
  StreamSession(tcp::socket socket, const MeshStore& store, std::shared_ptr<Connection> connection, std::unique_ptr<AddressLimits::Visitor> visitor)
      : socket_(std::move(socket)),
        wake_(socket_.get_executor()),
        clock_(socket_.get_executor()),
        protocol_(store),
        connection_(std::move(connection)),
        visitor_(std::move(visitor)) {}

  asio::awaitable<void> run(StreamHandshake handshake);
  /// Ends the session by the server's own fault.
  void fail() {
    close(CloseCode::kInternal);
    wake_.cancel();
  }

 private:
  enum class Reading : std::uint8_t { kWaits, kEnded };
  Reading readSome();
  asio::awaitable<void> read();
  asio::awaitable<void> write();
  asio::awaitable<void> keepTime();
  asio::awaitable<void> waitForNews();
  asio::awaitable<void> flush(FrameGather& gather);
  /// Whether the session goes on.
  bool take(std::string_view bytes);
  bool handle(Event event);
  void collect(FrameGather& gather);
  void close(CloseCode code);
  /// Ends reading and writing at once.
  void cut() {
    error_code ec;
    ended_ = true;
    socket_.close(ec);
    clock_.cancel();
    wake_.cancel();
  }

  tcp::socket socket_;
  asio::steady_timer wake_, clock_;
  StreamProtocol protocol_;
  WebSocketReader reader_;
  std::shared_ptr<Connection> connection_;
  std::unique_ptr<AddressLimits::Visitor> visitor_;

  std::optional<std::string> pong_;   // the payload of the last ping that is not answered yet
  bool ping_ = false;                 // one is due
  std::optional<std::string> close_;  // the payload of the close frame to send
  bool closeSent_ = false;
  bool deaf_ = false;                 // what still comes is read and thrown away
  std::size_t drained_ = 0;           // bytes of it
  bool ended_ = false;                // nothing can be written any more

  Clock::time_point heard_ = Clock::now();    // when bytes last came
  bool writing_ = false;
  Clock::time_point written_{};               // when the client last took some of what is being written
  Clock::time_point second_{};                // the window that pings_ belongs to
  unsigned pings_ = 0;
};


std::string closePayload(CloseCode code) {
  const auto number = static_cast<std::uint16_t>(code);
  return {static_cast<char>(number >> 8), static_cast<char>(number & 0xFF)};
}

std::string handshakeAnswer(const std::string& key) {
  return "HTTP/1.1 101 Switching Protocols\r\nUpgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Accept: " + webSocketAccept(key) +
         "\r\nSec-WebSocket-Protocol: " + std::string(kStreamSubprotocol) + "\r\nServer: qtet-server/" QTET_VERSION "\r\n\r\n";
}

void StreamSession::close(CloseCode code) {
  if (!close_ && !closeSent_) close_ = closePayload(code);
}

bool StreamSession::handle(Event event) {
  switch (event.kind) {
    case Event::Kind::kText: protocol_.receive(event.payload, Clock::now()); break;
    case Event::Kind::kBinary: protocol_.receiveBinary(); break;
    case Event::Kind::kPong: break;
    case Event::Kind::kPing:
      if (heard_ - second_ >= std::chrono::seconds(1)) second_ = heard_, pings_ = 0;
      if (++pings_ > limits::kMaxPingsPerSecond) return close(CloseCode::kPolicy), false;
      pong_ = std::move(event.payload);
      break;
    case Event::Kind::kClose:
      if (!closeSent_) close_ = event.payload.substr(0, 2);  // the client's own code, as RFC 6455 suggests
      return false;
  }
  return true;
}

bool StreamSession::take(std::string_view bytes) {
  heard_ = Clock::now();
  reader_.feed(bytes);
  for (;;) {
    auto event = reader_.next();
    if (!event) return close(event.error()), false;
    if (!*event) return true;
    if (!handle(std::move(**event))) return false;
  }
}

/// A plain function: a buffer in a coroutine would be held by every silent client.
StreamSession::Reading StreamSession::readSome() {
  std::array<char, kReadBytes> bytes;
  for (int i = 0; i < kReadsInARow; ++i) {
    error_code ec;
    const std::size_t count = socket_.read_some(asio::buffer(bytes), ec);
    if (ec == asio::error::would_block) return Reading::kWaits;
    if (ec) return Reading::kEnded;
    drained_ += deaf_ ? count : 0;
    if (drained_ > limits::kLingerBytes) return Reading::kEnded;
    deaf_ = deaf_ || !take({bytes.data(), count});
    wake_.cancel();
  }
  return Reading::kWaits;  // others' turn
}

/// Also behind the last word that counts: closing while bytes of the client's lie unread would reset the connection, and ours might be lost.
asio::awaitable<void> StreamSession::read() {
  for (;;) {
    if (ended_ || readSome() == Reading::kEnded) break;
    error_code ec;
    co_await socket_.async_wait(tcp::socket::wait_read, redirect_error(use_awaitable, ec));
  }
  cut();
}

void StreamSession::collect(FrameGather& gather) {
  if (pong_) gather.add(WebSocketHeader::kPong, *std::exchange(pong_, std::nullopt));
  if (std::exchange(ping_, false)) gather.add(WebSocketHeader::kPing, {});
  while (!gather.full() && !close_) {
    std::optional<Outgoing> outgoing = protocol_.next();
    if (!outgoing) {
      // What the credit allows is still sent; the rest comes elsewhere, after an `open` with `have`.
      if (connection_->ending()) close(CloseCode::kGoingAway);
      break;
    }
    if (auto* text = std::get_if<std::string>(&*outgoing)) {
      gather.add(WebSocketHeader::kText, std::move(*text));
    } else if (auto* frame = std::get_if<OutgoingFrame>(&*outgoing)) {
      gather.add(std::move(*frame));
    } else {
      close(std::get<CloseCode>(*outgoing));
    }
  }
  if (close_ && !gather.full()) {
    gather.add(WebSocketHeader::kClose, *std::exchange(close_, std::nullopt));
    closeSent_ = true;
  }
}

asio::awaitable<void> StreamSession::write() {
  connection_->onEnd([this] { wake_.cancel(); });
  while (!ended_ && !closeSent_) {
    FrameGather gather;
    collect(gather);
    if (gather.empty()) {
      co_await waitForNews();
    } else {
      co_await flush(gather);
    }
  }
  connection_->onEnd({});
}

asio::awaitable<void> StreamSession::flush(FrameGather& gather) {
  writing_ = true;
  written_ = Clock::now();
  while (!ended_ && !gather.written()) {
    error_code ec;
    const std::size_t count = gather.write(socket_, ec);
    if (count > 0) written_ = Clock::now();
    if (ec == asio::error::would_block) co_await socket_.async_wait(tcp::socket::wait_write, redirect_error(use_awaitable, ec));
    if (ec) cut();
  }
  writing_ = false;
}

/// One executor runs reader, writer, clock and the server's end, so nothing can happen between the writer's last look and this wait.
asio::awaitable<void> StreamSession::waitForNews() {
  error_code ec;
  wake_.expires_at(asio::steady_timer::time_point::max());
  co_await wake_.async_wait(redirect_error(use_awaitable, ec));
}

/// Pings a silent client, gives up one that stays so, takes nothing that waits for it, or does not close.
asio::awaitable<void> StreamSession::keepTime() {
  while (!ended_) {
    error_code ec;
    const bool closing = closeSent_;
    clock_.expires_after(closing ? limits::kClosingTime : limits::kSilenceTime / 2);
    co_await clock_.async_wait(redirect_error(use_awaitable, ec));
    if (ended_) break;
    const auto now = Clock::now();
    if (ec) continue;  // the writer has closed
    if (closing || now - heard_ >= limits::kSilenceTime || (writing_ && now - written_ >= limits::kWriteTime)) {
      cut();
    } else if (now - heard_ >= limits::kSilenceTime / 2) {
      ping_ = true;
      wake_.cancel();
    }
  }
}

asio::awaitable<void> StreamSession::run(StreamHandshake handshake) {
  error_code ec;
  socket_.non_blocking(true, ec);
  (void)::setsockopt(socket_.native_handle(), IPPROTO_TCP, TCP_NOTSENT_LOWAT, &kUnsentBytes, sizeof(kUnsentBytes));
  const std::string answer = handshakeAnswer(handshake.key);
  socket_.write_some(asio::buffer(answer), ec);  // an empty socket takes it at once
  if (ec) co_return;
  const auto ended = [self = shared_from_this()](const std::exception_ptr& thrown) {
    if (thrown) self->fail();
  };
  const auto executor = socket_.get_executor();
  deaf_ = !take(handshake.firstBytes);
  asio::co_spawn(
      executor, [self = shared_from_this()] { return self->read(); }, ended);
  asio::co_spawn(
      executor, [self = shared_from_this()] { return self->keepTime(); }, ended);
  co_await write();
  clock_.cancel();
  if (!ended_) socket_.shutdown(tcp::socket::shutdown_send, ec);
}

}  // namespace

asio::awaitable<void> serveStream(tcp::socket socket, StreamHandshake handshake, const MeshStore& store, std::shared_ptr<Connection> connection,
                                  std::unique_ptr<AddressLimits::Visitor> visitor) {
  const auto session = std::make_shared<StreamSession>(std::move(socket), store, std::move(connection), std::move(visitor));
  co_await session->run(std::move(handshake));
}

}  // namespace qtet
