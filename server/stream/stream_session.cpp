#include "server/stream/stream_session.h"

#include <netinet/tcp.h>
#include <sys/socket.h>

#include <spdlog/spdlog.h>

#include <array>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/redirect_error.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <exception>
#include <optional>

#include "server/stream/frame_gather.h"
#include "server/stream/stream_protocol.h"
#include "server/wire/limits.h"
#include "server/wire/web_socket_reader.h"

namespace qtet {
namespace {

namespace asio = boost::asio;
using asio::redirect_error;
using asio::use_awaitable;
using boost::system::error_code;
using Clock = std::chrono::steady_clock;
using Event = WebSocketReader::Event;

/// On the stack of whoever reads, so that a silent client has no buffer.
constexpr std::size_t kReadBytes = 4096;
/// Bytes that the kernel may hold unsent: so a superseded order stops soon, and a stalled client
/// costs little.
constexpr int kUnsentBytes = 80 << 10;
/// Before other connections of the thread have their turn.
constexpr int kReadsInARow = 8;

/// A reader, a writer and a clock on one executor. The writer alone writes, also pongs and closes,
/// so that nothing comes between the parts of a frame; the reader wakes it when there is something
/// to say. All hold the session, so it ends with the last of them.
class StreamSession : public std::enable_shared_from_this<StreamSession> {
 public:
  StreamSession(ClientSocket socket, StreamProtocol protocol,
                std::shared_ptr<Connection> connection,
                std::unique_ptr<AddressLimits::Client> client)
      : socket_(std::move(socket)),
        wake_(socket_.get_executor()),
        clock_(socket_.get_executor()),
        protocol_(std::move(protocol)),
        connection_(std::move(connection)),
        client_(std::move(client)) {}

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
  void hear(std::string_view bytes);
  /// Has the intervals found that the view wants; ends with its subscription.
  void findIntervals();
  void collect(FrameGather& gather);
  void close(CloseCode code);
  void holdBack(bool hold) {
    if (held_ != hold) socket_.holdBack(hold);
    held_ = hold;
  }
  /// Ends reading and writing at once.
  void cut() {
    ended_ = true;
    socket_.close();
    clock_.cancel();
    wake_.cancel();
  }

  ClientSocket socket_;
  asio::steady_timer wake_, clock_;
  StreamProtocol protocol_;
  WebSocketReader reader_;
  std::shared_ptr<Connection> connection_;
  std::unique_ptr<AddressLimits::Client> client_;

  LevelJobs* jobs_ = nullptr;
  LevelJobs::Subscription intervals_;  // of `intervalsOf_`
  MeshPointer intervalsOf_;            // are being found

  std::optional<std::string> pong_;   // the payload of the last ping that is not answered yet
  bool ping_ = false;                 // one is due
  std::optional<std::string> close_;  // the payload of the close frame to send
  bool closeSent_ = false;
  bool deaf_ = false;        // what still comes is read and thrown away
  std::size_t drained_ = 0;  // bytes of it
  bool ended_ = false;       // nothing can be written any more

  Clock::duration silence_{}, writeTime_{};  // as the handshake says
  Clock::time_point heard_ = Clock::now();   // when bytes last came
  bool unpaced_ = false;
  // until nothing more is to be written: else each frame would end a packet
  bool held_ = false;
  bool writing_ = false;
  // when the client last took some of what is being written
  Clock::time_point written_{};
  Clock::time_point second_{};  // the window that pings_ belongs to
  unsigned pings_ = 0;
};

std::string closePayload(CloseCode code) {
  const auto number = static_cast<std::uint16_t>(code);
  return {static_cast<char>(number >> 8), static_cast<char>(number & 0xFF)};
}

std::string handshakeAnswer(const std::string& key) {
  return "HTTP/1.1 101 Switching Protocols\r\nUpgrade: websocket\r\nConnection: "
         "Upgrade\r\nSec-WebSocket-Accept: " +
         webSocketAccept(key) + "\r\nSec-WebSocket-Protocol: " + std::string(kStreamSubprotocol) +
         "\r\nServer: qtet-server/" QTET_VERSION "\r\n\r\n";
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
      // the client's own code, as RFC 6455 suggests
      if (!closeSent_) close_ = event.payload.substr(0, 2);
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

void StreamSession::hear(std::string_view bytes) {
  deaf_ = deaf_ || !take(bytes);
  if (jobs_ != nullptr && !deaf_) findIntervals();
}

void StreamSession::findIntervals() {
  MeshPointer mesh = protocol_.lacksIntervals();
  if (mesh == intervalsOf_) return;
  intervals_ = {};
  intervalsOf_ = nullptr;
  if (!mesh) return;
  const LevelRequest request{mesh, 0, LevelForm::kIntervals};
  const auto keep = [mesh](const LevelFile& table) {
    mesh->intervals->put(PacketIntervals::decode(table.bytes, mesh->log.index(), mesh->manifest));
  };
  if (const std::optional<LevelFile> kept = jobs_->find(request)) {
    keep(*kept);
    return protocol_.intervalsCame(mesh);
  }
  auto done = [keep, mesh, weak = weak_from_this(),
               executor = socket_.get_executor()](Result<LevelFile> table) {
    if (table)
      keep(*table);
    else
      spdlog::error("{}: the values of its packets cannot be found: {}", mesh->id,
                    table.error().text());
    // nor by trying again
    if (!table && table.error().code != ErrorCode::kIo) mesh->intervals->put({});
    asio::post(executor, [mesh, weak] {
      const auto self = weak.lock();
      if (!self) return;
      self->protocol_.intervalsCame(mesh);
      self->wake_.cancel();
    });
  };
  auto subscription =
      jobs_->submit(request, std::move(done), client_ ? client_->address() : nullptr);
  if (!subscription) return;  // too many jobs; the next view tries again
  intervals_ = std::move(*subscription);
  intervalsOf_ = std::move(mesh);
}

/// A plain function: a buffer in a coroutine would be held by every silent client.
StreamSession::Reading StreamSession::readSome() {
  std::array<char, kReadBytes> bytes;
  for (int i = 0; i < kReadsInARow; ++i) {
    error_code ec;
    const std::size_t count = socket_.read(bytes, ec);
    if (ec == asio::error::would_block) return Reading::kWaits;
    if (ec) return Reading::kEnded;
    drained_ += deaf_ ? count : 0;
    if (drained_ > limits::kLingerBytes) return Reading::kEnded;
    hear({bytes.data(), count});
    wake_.cancel();
  }
  return Reading::kWaits;  // others' turn
}

/// Also behind the last word that counts: closing while bytes of the client's lie unread would
/// reset the connection, and ours might be lost.
asio::awaitable<void> StreamSession::read() {
  for (;;) {
    if (ended_ || readSome() == Reading::kEnded) break;
    co_await socket_.waitToRead();
  }
  cut();
}

void StreamSession::collect(FrameGather& gather) {
  if (pong_) gather.add(WebSocketHeader::kPong, *std::exchange(pong_, std::nullopt));
  if (std::exchange(ping_, false)) gather.add(WebSocketHeader::kPing, {});
  while (!gather.full() && !close_) {
    std::optional<Outgoing> outgoing = protocol_.next();
    if (!outgoing) {
      // What the credit allows is still sent; the rest comes elsewhere, after an `open` with
      // `have`.
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
    bool idle = false;
    {  // an idle session holds no gather
      FrameGather gather;
      collect(gather);
      idle = gather.empty();
      if (idle ? held_ : unpaced_ && gather.several()) holdBack(!idle);
      if (!idle) co_await flush(gather);
    }
    if (idle) co_await waitForNews();
  }
  if (!ended_) holdBack(false);
  connection_->onEnd({});
}

asio::awaitable<void> StreamSession::flush(FrameGather& gather) {
  writing_ = true;
  written_ = Clock::now();
  while (!ended_ && !gather.written()) {
    error_code ec;
    const std::size_t count = gather.write(socket_, ec);
    if (count > 0) written_ = Clock::now();
    if (ec == asio::error::would_block) ec = co_await socket_.waitToWrite();
    if (ec) cut();
  }
  writing_ = false;
}

/// One executor runs reader, writer, clock and the server's end, so nothing can happen between the
/// writer's last look and this wait.
asio::awaitable<void> StreamSession::waitForNews() {
  error_code ec;
  wake_.expires_at(asio::steady_timer::time_point::max());
  co_await wake_.async_wait(redirect_error(use_awaitable, ec));
}

/// Pings a silent client, gives up one that stays so, takes nothing that waits for it, or does not
/// close.
asio::awaitable<void> StreamSession::keepTime() {
  while (!ended_) {
    error_code ec;
    const bool closing = closeSent_;
    clock_.expires_after(closing ? Clock::duration(limits::kClosingTime) : silence_ / 2);
    co_await clock_.async_wait(redirect_error(use_awaitable, ec));
    if (ended_) break;
    const auto now = Clock::now();
    if (ec) continue;  // the writer has closed
    if (closing || now - heard_ >= silence_ || (writing_ && now - written_ >= writeTime_)) {
      cut();
    } else if (now - heard_ >= silence_ / 2) {
      ping_ = true;
      wake_.cancel();
    }
  }
}

asio::awaitable<void> StreamSession::run(StreamHandshake handshake) {
  (void)::setsockopt(socket_.number(), IPPROTO_TCP, TCP_NOTSENT_LOWAT, &kUnsentBytes,
                     sizeof(kUnsentBytes));
  silence_ = handshake.silence;
  writeTime_ = handshake.write;
  unpaced_ = handshake.unpaced;
  const std::string answer = handshakeAnswer(handshake.key);
  const iovec part{const_cast<char*>(answer.data()), answer.size()};
  error_code ec;
  const std::size_t taken = socket_.write({&part, 1}, false, ec);
  if (taken < answer.size()) co_return;  // an empty socket takes it at once
  const auto ended = [self = shared_from_this()](const std::exception_ptr& thrown) {
    if (thrown) self->fail();
  };
  const auto executor = socket_.get_executor();
  jobs_ = handshake.jobs;
  hear(handshake.firstBytes);
  asio::co_spawn(executor, [self = shared_from_this()] { return self->read(); }, ended);
  asio::co_spawn(executor, [self = shared_from_this()] { return self->keepTime(); }, ended);
  co_await write();
  clock_.cancel();
  if (!ended_) socket_.finishSending();
}

}  // namespace

asio::awaitable<void> serveStream(ClientSocket socket, StreamHandshake handshake,
                                  const MeshStore& store, std::shared_ptr<Connection> connection,
                                  std::unique_ptr<AddressLimits::Client> client) {
  const auto session = std::make_shared<StreamSession>(
      std::move(socket), StreamProtocol(store, std::move(handshake.mayRead)), std::move(connection),
      std::move(client));
  co_await session->run(std::move(handshake));
}

}  // namespace qtet
