#include "server/stream/stream_session.h"

#include <netinet/tcp.h>
#include <sys/socket.h>

#include <spdlog/spdlog.h>

#include <algorithm>
#include <array>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/redirect_error.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <exception>
#include <memory>
#include <optional>

#include "proto/version.h"
#include "server/stream/control_frames.h"
#include "server/stream/frame_gather.h"
#include "server/stream/line_room.h"
#include "server/stream/patience.h"
#include "server/stream/stream_input.h"
#include "server/stream/stream_limits.h"
#include "server/stream/stream_protocol.h"
#include "server/wire/charge.h"
#include "server/wire/connection_limits.h"
#include "server/wire/http_limits.h"
#include "server/wire/turns.h"

namespace qtet {
namespace {

namespace asio = boost::asio;
using asio::redirect_error;
using asio::use_awaitable;
using boost::system::error_code;
using Clock = std::chrono::steady_clock;

/// The read buffer is on the stack, so that a silent client has none.
constexpr std::size_t kReadBytes = 4096;
/// Bytes that the kernel may hold unsent: so a superseded order stops soon, and a stalled client
/// costs little.
constexpr int kUnsentBytes = 80 << 10;
/// The close reason that a silent client receives.
constexpr std::string_view kSilenceReason = "no message and no pong came for too long";
/// The label of its turns.
constexpr std::string_view kRoute = kRouteLabels[static_cast<std::size_t>(RouteLabel::kStream)];
/// Before other connections of the thread have their turn.
constexpr int kReadsInARow = 8;

/// Holds several frames back until nothing more is to be written: else each of them would end a
/// packet. Does nothing on a paced connection.
class Cork {
 public:
  Cork(ClientSocket& socket, bool unpaced) : socket_(socket), unpaced_(unpaced) {}
  void hold() {
    if (!unpaced_ || held_) return;
    held_ = true;
    socket_.holdBack(true);
  }
  void release() {
    if (!held_) return;
    held_ = false;
    socket_.holdBack(false);
  }

 private:
  ClientSocket& socket_;
  const bool unpaced_;
  bool held_ = false;
};

/// Why a stream ended, in the access log's words.
std::string_view reasonOf(CloseCode code) {
  switch (code) {
    case CloseCode::kGoingAway: return "server-ends";
    case CloseCode::kPolicy: return "refused";
    case CloseCode::kInternal: return "fault";
    default: return "wrong-frame";
  }
}

/// A reader, a writer and a clock on one executor. Only the writer writes, pongs and closes
/// included, so that nothing separates the parts of a frame. The reader wakes it when there is
/// something to send. All three keep the session alive, so it ends with the last of them. Nothing
/// is read or written after the socket is closed.
class StreamSession : public std::enable_shared_from_this<StreamSession> {
 public:
  StreamSession(Peer peer, StreamProtocol protocol, const StreamHandshake& handshake,
                Metrics& metrics, AccessLog* log)
      : peer_(std::move(peer)),
        wake_(peer_.socket.get_executor()),
        clock_(peer_.socket.get_executor()),
        protocol_(std::move(protocol)),
        input_(protocol_, control_),
        patience_(handshake.silence, handshake.write, Clock::now()),
        cork_(peer_.socket, handshake.unpaced),
        bounded_(!handshake.unpaced),
        metrics_(metrics),
        report_(metrics, log, handshake.request, Clock::now()) {}
  ~StreamSession() {
    if (const auto code = control_.ownCode())
      report_.ends(reasonOf(*code));
    else if (control_.closing())
      report_.ends("closed-by-client");
  }
  StreamSession(const StreamSession&) = delete;
  StreamSession& operator=(const StreamSession&) = delete;

  asio::awaitable<void> run(StreamHandshake handshake);
  /// Ends the session by the server's own fault.
  void fail() {
    control_.close(CloseCode::kInternal);
    wake_.cancel();
  }

 private:
  enum class Reading : std::uint8_t { kWaits, kEnded };
  Reading readSome();
  void hear(std::string_view bytes);
  asio::awaitable<void> read();
  asio::awaitable<void> giveWay();
  asio::awaitable<void> write();
  asio::awaitable<void> keepTime();
  asio::awaitable<void> waitForNews();
  asio::awaitable<void> waitForRoom();
  asio::awaitable<void> flush(FrameGather& gather);
  std::size_t room();
  void collect(FrameGather& gather);
  /// Ends reading and writing at once.
  void cut() {
    peer_.socket.close();
    clock_.cancel();
    wake_.cancel();
  }

  Peer peer_;
  asio::steady_timer wake_, clock_;
  StreamProtocol protocol_;
  ControlFrames control_;
  StreamInput input_;
  Patience patience_;
  Cork cork_;
  const bool bounded_;  // by line_; a client of this machine has no line
  LineRoom line_;
  Metrics& metrics_;
  StreamReport report_;
};

std::string handshakeAnswer(const std::string& key) {
  return "HTTP/1.1 101 Switching Protocols\r\nUpgrade: websocket\r\nConnection: "
         "Upgrade\r\nSec-WebSocket-Accept: " +
         webSocketAccept(key) + "\r\nSec-WebSocket-Protocol: " + std::string(kStreamSubprotocol) +
         "\r\nServer: qtet-server/" + version() + "\r\n\r\n";
}

void StreamSession::hear(std::string_view bytes) {
  const Charge charge(peer_.client.get(), &metrics_, kRoute);
  const auto now = Clock::now();
  if (input_.listens()) patience_.heard(now);
  const std::uint32_t opens = protocol_.opens();
  input_.take(bytes, now);
  if (protocol_.opens() != opens && protocol_.mesh()) report_.opened(protocol_.mesh()->id, now);
}

/// A plain function: a buffer in a coroutine would be held by every silent client.
StreamSession::Reading StreamSession::readSome() {
  std::array<char, kReadBytes> bytes;
  for (int i = 0; i < kReadsInARow; ++i) {
    error_code ec;
    const std::size_t count = peer_.socket.read(bytes, ec);
    if (ec == asio::error::would_block) return Reading::kWaits;
    if (ec) return Reading::kEnded;
    hear({bytes.data(), count});
    if (input_.ignoredBytes() > limits::kLingerBytes) return Reading::kEnded;
    wake_.cancel();
  }
  return Reading::kWaits;  // others' turn
}

/// Also behind the last word that counts: closing while bytes of the client's lie unread would
/// reset the connection, and ours might be lost.
asio::awaitable<void> StreamSession::read() {
  while (peer_.socket.isOpen() && readSome() != Reading::kEnded) {
    co_await peer_.socket.waitToRead();
    if (owesTurn(peer_.client.get())) co_await giveWay();
  }
  cut();
}

/// Views cost the server much more than the client.
asio::awaitable<void> StreamSession::giveWay() {
  co_await takeTurn(peer_.socket.get_executor(), peer_.client.get());
  asio::steady_timer rest(peer_.socket.get_executor());
  while (peer_.socket.isOpen() && peer_.client->overdrawn()) {
    error_code ec;
    rest.expires_after(limits::kOverdrawnRest);
    co_await rest.async_wait(redirect_error(use_awaitable, ec));
  }
}

/// Bytes that the line has room for.
std::size_t StreamSession::room() {
  const auto figures = bounded_ ? lineFigures(peer_.socket.number()) : std::nullopt;
  if (!figures) return LineRoom::kUnbounded;
  const std::size_t bytes = line_.room(*figures, Clock::now());
  if (line_.progressed()) patience_.took(Clock::now());
  return bytes;
}

void StreamSession::collect(FrameGather& gather) {
  const Charge charge(peer_.client.get(), &metrics_, kRoute);
  std::size_t left = protocol_.hasFrame() ? room() : LineRoom::kUnbounded;
  while (std::optional<ControlFrame> sign = control_.takeSign())
    gather.add(sign->kind, std::move(sign->payload));
  while (!gather.full() && !control_.closing()) {
    std::optional<Outgoing> outgoing =
        protocol_.next(left, bounded_ ? line_.piece() : LineRoom::kUnbounded);
    if (!outgoing) {
      if (protocol_.hasFrame()) break;
      // The server still sends as much as the credit allows. The client gets the rest elsewhere,
      // after an `open` with `have`.
      if (peer_.connection->ending()) control_.close(CloseCode::kGoingAway);
      break;
    }
    if (auto* text = std::get_if<std::string>(&*outgoing)) {
      gather.add(WebSocketHeader::kText, std::move(*text));
    } else if (auto* frame = std::get_if<OutgoingFrame>(&*outgoing)) {
      left -= std::min(left, frame->payload.size());
      gather.add(std::move(*frame));
    } else {
      control_.close(std::get<CloseCode>(*outgoing));
    }
  }
  if (gather.full()) return;
  if (std::optional<ControlFrame> last = control_.takeClose())
    gather.add(last->kind, std::move(last->payload));
}

asio::awaitable<void> StreamSession::write() {
  peer_.connection->onEnd([this] { wake_.cancel(); });
  while (peer_.socket.isOpen() && !control_.closed()) {
    bool idle = false;
    {  // an idle session holds no gather
      FrameGather gather;
      collect(gather);
      idle = gather.empty();
      if (gather.several()) cork_.hold();
      if (!idle) co_await flush(gather);
    }
    if (!idle) continue;
    cork_.release();
    if (protocol_.hasFrame()) {
      co_await waitForRoom();
      continue;
    }
    line_.rests();
    patience_.wrote();
    if (protocol_.lacksCredit()) report_.lacksCredit();
    co_await waitForNews();
  }
  if (peer_.socket.isOpen()) cork_.release();
  peer_.connection->onEnd({});
}

asio::awaitable<void> StreamSession::flush(FrameGather& gather) {
  patience_.begins(Clock::now());
  while (peer_.socket.isOpen() && !gather.written()) {
    error_code ec;
    const std::size_t count = gather.write(peer_.socket, ec);
    if (count > 0) patience_.took(Clock::now());
    report_.took(count);
    if (ec == asio::error::would_block) {
      const auto since = Clock::now();
      ec = co_await peer_.socket.waitToWrite();
      report_.stalled(Clock::now() - since);
    }
    if (ec) cut();
  }
  if (gather.written()) report_.wroteFrames(gather.frames(), Clock::now());
  patience_.wrote();
}

/// One executor runs reader, writer, clock and the server's end, so nothing can happen between the
/// writer's last look and this wait.
asio::awaitable<void> StreamSession::waitForNews() {
  error_code ec;
  wake_.expires_at(asio::steady_timer::time_point::max());
  co_await wake_.async_wait(redirect_error(use_awaitable, ec));
}

/// Until the line may have taken enough, or there is news: a changed view is answered at once.
asio::awaitable<void> StreamSession::waitForRoom() {
  const auto since = Clock::now();
  patience_.begins(since);
  error_code ec;
  wake_.expires_after(line_.wait());
  co_await wake_.async_wait(redirect_error(use_awaitable, ec));
  report_.stalled(Clock::now() - since);
}

/// Pings a silent client, closes on one that stays so, and cuts one that takes nothing of what
/// waits for it, or does not close.
asio::awaitable<void> StreamSession::keepTime() {
  while (peer_.socket.isOpen()) {
    error_code ec;
    const bool closing = control_.closed();
    clock_.expires_after(closing ? Clock::duration(limits::kClosingTime) : patience_.interval());
    co_await clock_.async_wait(redirect_error(use_awaitable, ec));
    if (ec) continue;  // the writer has closed, or the session was cut
    const Patience::Verdict verdict = patience_.at(Clock::now());
    if (closing || verdict == Patience::Verdict::kStuck) {
      if (!closing) report_.ends("stuck");
      cut();  // in the midst of a frame nothing can be said
    } else if (verdict == Patience::Verdict::kSilent) {
      report_.ends("silent");
      control_.close(CloseCode::kPolicy, kSilenceReason);
      wake_.cancel();
    } else if (verdict == Patience::Verdict::kPing) {
      control_.ping();
      wake_.cancel();
    }
  }
}

asio::awaitable<void> StreamSession::run(StreamHandshake handshake) {
  (void)::setsockopt(peer_.socket.number(), IPPROTO_TCP, TCP_NOTSENT_LOWAT, &kUnsentBytes,
                     sizeof(kUnsentBytes));
  const auto ended = [self = shared_from_this()](const std::exception_ptr& thrown) {
    if (thrown) self->fail();
  };
  const auto executor = peer_.socket.get_executor();
  hear(handshake.firstBytes);
  asio::co_spawn(executor, [self = shared_from_this()] { return self->read(); }, ended);
  asio::co_spawn(executor, [self = shared_from_this()] { return self->keepTime(); }, ended);
  {
    FrameGather answer;
    answer.addAnswer(handshakeAnswer(handshake.key));
    co_await flush(answer);  // answers to earlier requests may still fill the socket
  }
  co_await write();
  clock_.cancel();
  if (peer_.socket.isOpen()) peer_.socket.finishSending();
}

}  // namespace

asio::awaitable<void> serveStream(Peer peer, StreamHandshake handshake, const MeshStore& store,
                                  Metrics& metrics, AccessLog* log) {
  const auto session = std::make_shared<StreamSession>(
      std::move(peer), StreamProtocol(store, std::move(handshake.mayRead)), handshake, metrics,
      log);
  co_await session->run(std::move(handshake));
}

}  // namespace qtet
