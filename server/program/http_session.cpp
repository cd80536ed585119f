#include "server/program/http_session.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <array>
#include <boost/asio/async_result.hpp>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/parser.hpp>
#include <limits>
#include <optional>
#include <span>

#include "server/http/client_watch.h"
#include "server/http/deadline.h"
#include "server/http/http_resource.h"
#include "server/http/level_wait.h"
#include "server/program/http_request.h"
#include "server/routes/access_routes.h"
#include "server/routes/http_router.h"
#include "server/stream/stream_session.h"
#include "server/wire/http_gate.h"

namespace qtet {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
using asio::use_awaitable;
using beast::error_code;
using Parser = http::request_parser<http::empty_body>;
using Clock = std::chrono::steady_clock;

constexpr std::size_t kReadBytes = 4096;
constexpr std::string_view kContinue = "HTTP/1.1 100 Continue\r\n\r\n";

Reply tooLong() {
  return problem(431, "header-too-large",
                 "at most " + std::to_string(limits::kMaxHeaderBytes) + " bytes and " +
                     std::to_string(limits::kMaxHeaderLines) + " lines of request head are read");
}

Reply busy(unsigned status, std::string_view type, std::string_view detail, unsigned seconds) {
  Reply out = problem(status, type, detail);
  out.headers.emplace_back("Retry-After", std::to_string(seconds));
  return out;
}

Reply refusedLevel(LevelRefusal refusal) {
  if (refusal == LevelRefusal::kAddress)
    return busy(429, "too-many-requests",
                "as many levels are being made for this address as may be; try again",
                limits::kRetryAfterSeconds);
  return busy(503, "busy", "too many levels are being made; try again", limits::kRetryAfterSeconds);
}

Reply failedLevel(const Error& error) {
  const std::string why = error.code == ErrorCode::kIo
                              ? "the level cannot be made: "
                              : "this log cannot be decoded, though its checksums hold; qtet "
                                "verify says the same, and it has to be written anew: ";
  return problem(500, "internal", why + error.text());
}

/// Whether bytes follow the head. Unless they are read, what comes after them cannot be told from
/// them, and the connection must end.
bool hasBody(const RequestView& request) {
  return request.contentLength &&
         request.contentLength->find_first_not_of('0') != std::string_view::npos;
}

/// The answer to a head that Beast's parser does not take.
Reply answerToParseError(const error_code& ec) {
  if (ec == http::error::header_limit || ec == http::error::buffer_overflow) return tooLong();
  if (ec == http::error::bad_version)
    return problem(505, "version-not-supported", "this server speaks HTTP/1.1 and HTTP/1.0");
  return problem(400, "bad-request", "this is not HTTP: " + ec.message());
}

class HttpSession {
 public:
  HttpSession(ClientSocket socket, const Services& services, std::shared_ptr<Connection> connection,
              std::unique_ptr<AddressLimits::Client> client)
      : socket_(std::move(socket)),
        services_(services),
        connection_(std::move(connection)),
        client_(std::move(client)),
        buffer_(limits::kMaxHeaderBytes) {
    connection_->onEnd([this] {
      if (idle_) socket_.cancel();
    });
  }
  ~HttpSession() {
    if (connection_) connection_->onEnd({});
  }
  HttpSession(const HttpSession&) = delete;
  HttpSession& operator=(const HttpSession&) = delete;

  asio::awaitable<void> run();

 private:
  asio::awaitable<bool> shakeHands();
  /// False: no place came free in the time for a handshake, or the connection ends.
  asio::awaitable<bool> waitForPlace(Handshakes::Client& handshake, const Deadline& deadline);
  asio::awaitable<bool> waitForBytes();
  void readSome(error_code& ec, std::size_t most = kReadBytes);
  /// The whole head parsed; nullopt: the connection has ended, or was refused.
  asio::awaitable<bool> readHead(Parser& parser);
  /// Reads a request and answers it; false: the connection is not to be used further. A coroutine
  /// of its own, so that a silent client holds none of what a request needs.
  asio::awaitable<bool> serveRequest();
  /// Notes what figures and log tell of a request; the answer to it if nothing of what it asks for
  /// matters.
  std::optional<Reply> begin(const RequestHeader& header);
  asio::awaitable<bool> becomeStream(Parser& parser);
  /// Answers one request; false: the connection is not to be used further.
  asio::awaitable<bool> answer(const RequestHeader& request, bool keepAlive);
  asio::awaitable<bool> answerLevel(const RequestView& request, Reply reply,
                                    const LevelRequest& level, bool keepAlive);
  asio::awaitable<bool> answerUpload(const RequestView& request, const UploadRequest& upload,
                                     bool keepAlive);
  /// Reads the body into the upload; the answer, if it ends before its time. A connection that is
  /// lost has none to send.
  asio::awaitable<std::optional<Reply>> receiveBody(Upload& upload, std::uint64_t bytes);
  asio::awaitable<Reply> remove(const UploadRequest& upload);
  /// Has the log checked and published; nullopt: the client has gone, and the check was broken off.
  asio::awaitable<std::optional<Reply>> finish(Upload& upload);
  asio::awaitable<bool> send(Reply reply, bool keepAlive);
  /// The body out of its file, where there is one.
  asio::awaitable<bool> write(std::string_view head, ByteView body,
                              std::optional<FilePart> file = {});
  asio::awaitable<void> refuse(Reply reply);
  asio::awaitable<void> linger();
  [[nodiscard]] std::string_view buffered() const {
    return {static_cast<const char*>(buffer_.data().data()), buffer_.size()};
  }
  void report(const Reply& reply, bool whole);

  ClientSocket socket_;
  const Services& services_;
  std::shared_ptr<Connection> connection_;
  std::unique_ptr<AddressLimits::Client> client_;
  beast::flat_buffer buffer_;
  bool idle_ = false;  // waits for a request, or a handshake, that nothing is lost by giving up

  // Of the request under way, for its answer's headers, the figures and the log.
  RequestTrace trace_;
  std::string method_, target_;
  Clock::time_point begun_ = Clock::now();
  // asked now: who leaves at once has no address afterwards
  const std::string peer_ = services_.accessLog != nullptr ? socket_.peer() : "";
  std::uint64_t sent_ = 0;
};

asio::awaitable<bool> HttpSession::shakeHands() {
  if (!socket_.isTls()) co_return true;
  {
    const Deadline deadline(socket_, services_.timeouts.header);
    idle_ = true;
    bool done = co_await socket_.announcesSoundHello();
    Handshakes::Client handshake(*services_.handshakes, socket_.get_executor(),
                                 [this] { socket_.cancel(); });
    if (done) done = co_await waitForPlace(handshake, deadline);
    if (done) done = co_await socket_.shakeHands();
    idle_ = false;
    if (done) co_return true;
  }
  if (socket_.becomePlainForPlainHttp())
    co_await refuse(
        problem(400, "bad-request", "this port speaks TLS; the address begins with https://"));
  co_return false;
}

/// What the client has sent stays in the kernel meanwhile.
asio::awaitable<bool> HttpSession::waitForPlace(Handshakes::Client& handshake,
                                                const Deadline& deadline) {
  while (const auto again = handshake.enter()) {
    std::optional<Deadline> retry;
    if (*again != Handshakes::Clock::time_point::max())
      retry.emplace(socket_, std::chrono::ceil<std::chrono::milliseconds>(*again - Clock::now()));
    const bool woken = co_await socket_.waitForCancel();
    if (!woken || deadline.passed() || connection_->ending()) co_return false;
  }
  co_return true;
}

/// What has come, without waiting.
void HttpSession::readSome(error_code& ec, std::size_t most) {
  std::array<char, kReadBytes> bytes;
  const std::size_t count = socket_.read(std::span(bytes).first(std::min(most, bytes.size())), ec);
  buffer_.commit(asio::buffer_copy(buffer_.prepare(count), asio::buffer(bytes, count)));
}

asio::awaitable<bool> HttpSession::waitForBytes() {
  buffer_.consume(emptyLinesBefore(buffered()));
  while (buffer_.size() == 0) {
    if (connection_->ending()) co_return false;
    error_code ec;
    readSome(ec);
    if (ec == asio::error::would_block) {
      buffer_ = beast::flat_buffer(limits::kMaxHeaderBytes);  // a silent client has none
      const Deadline deadline(socket_, services_.timeouts.idle);
      idle_ = true;
      ec = co_await socket_.waitToRead();
      idle_ = false;
    }
    if (ec) co_return false;
    buffer_.consume(emptyLinesBefore(buffered()));
  }
  co_return true;
}

asio::awaitable<bool> HttpSession::readHead(Parser& parser) {
  trace_ = traceOf(std::nullopt, std::nullopt);
  method_.clear();
  target_.clear();
  begun_ = Clock::now();
  HttpGate gate;
  std::optional<Deadline> deadline;  // most heads come in one piece
  std::optional<Reply> refusal;
  for (;;) {
    const HttpGate::Verdict verdict = gate.look(buffered());
    if (verdict == HttpGate::Verdict::kComplete) break;
    if (verdict == HttpGate::Verdict::kBroken)
      refusal = problem(
          400, "bad-request",
          "this is not HTTP/1.1: a bare line end, a control byte, a folded line or no method");
    if (verdict == HttpGate::Verdict::kTooLong || buffer_.size() >= limits::kMaxHeaderBytes)
      refusal = tooLong();
    error_code ec;
    if (!deadline) deadline.emplace(socket_, services_.timeouts.header);
    if (!refusal && !deadline->passed()) {
      readSome(ec, limits::kMaxHeaderBytes - buffer_.size());
      if (ec == asio::error::would_block) ec = co_await socket_.waitToRead();
    }
    if (!refusal && deadline->passed())
      refusal = problem(408, "request-timeout", "the request's head did not arrive in time");
    if (refusal) {
      co_await refuse(std::move(*refusal));
      co_return false;
    }
    if (ec) co_return false;
  }
  parser.header_limit(limits::kMaxHeaderBytes);
  // Bodies are the router's business. Not boost::none: Beast 1.74 then refuses a length of 0, too.
  parser.body_limit(std::numeric_limits<std::uint64_t>::max());
  error_code ec;
  parser.put(asio::buffer(buffered().data(), gate.headBytes()), ec);
  buffer_.consume(gate.headBytes());
  if (!ec && parser.is_header_done()) co_return true;
  co_await refuse(answerToParseError(ec));
  co_return false;
}

asio::awaitable<void> HttpSession::run() {
  trace_ = traceOf(std::nullopt, std::nullopt);
  const bool greeted = co_await shakeHands();
  while (greeted) {
    const bool begun = co_await waitForBytes();
    if (!begun) co_return;
    const bool again = co_await serveRequest();
    if (!again) co_return;
  }
}

asio::awaitable<bool> HttpSession::serveRequest() {
  Parser parser;
  const bool whole = co_await readHead(parser);
  if (!whole) co_return false;
  joinLists(parser.get());
  const bool keepAlive = parser.get().keep_alive();
  bool again = false;
  if (std::optional<Reply> early = begin(parser.get())) {
    const bool closes = early->close;
    again = co_await send(std::move(*early), keepAlive && !closes);
  } else if (services_.streams && isStreamHandshake(parser.get())) {
    co_await becomeStream(parser);
  } else {
    again = co_await answer(parser.get(), keepAlive);
  }
  co_return again;
}

std::optional<Reply> HttpSession::begin(const RequestHeader& header) {
  const RequestView view = viewOf(header);
  trace_ = traceOf(view.requestId, view.traceparent);
  method_ = view.method;
  target_ = view.target;
  if (const std::size_t query = target_.find('?');
      target_.find("ticket", std::min(query, target_.size())) != std::string::npos)
    target_.erase(query);  // a ticket that is perhaps still good, wherever it was sent
  if (std::optional<Reply> refusal = refusalOf(header)) {
    refusal->close = true;
    return refusal;
  }
  if (!client_ || client_->countRequest()) return std::nullopt;
  Reply out =
      busy(429, "too-many-requests", "this address asks too often; come back in a moment", 1);
  out.close = hasBody(view);
  return out;
}

asio::awaitable<bool> HttpSession::becomeStream(Parser& parser) {
  if (std::optional<Reply> refusal = handshakeRefusal(parser.get(), services_.allowedOrigins)) {
    co_await refuse(std::move(*refusal));
    co_return false;
  }
  std::expected<MayRead, Reply> mayRead = admitStream(viewOf(parser.get()), services_.access);
  if (!mayRead) {
    co_await refuse(std::move(mayRead.error()));
    co_return false;
  }
  connection_->onEnd({});
  const auto key = parser.get()[http::field::sec_websocket_key];
  StreamHandshake handshake{std::string(key.data(), key.size()),
                            std::string(buffered()),
                            std::move(*mayRead),
                            services_.timeouts.silence,
                            services_.timeouts.write,
                            &services_.jobs,
                            services_.unpaced};
  // A coroutine of its own, so that what a request needed goes.
  const auto executor = socket_.get_executor();
  asio::co_spawn(executor,
                 serveStream(std::move(socket_), std::move(handshake), services_.store,
                             std::move(connection_), std::move(client_)),
                 [](const std::exception_ptr& thrown) {
                   if (thrown) spdlog::error("a stream ended by an exception");
                 });
  co_return true;
}

asio::awaitable<bool> HttpSession::answer(const RequestHeader& request, bool keepAlive) {
  const RequestView view = viewOf(request);
  Answer answer = services_.route(view);
  keepAlive = keepAlive && !answer.reply.close;
  bool again = false;
  if (const auto* level = std::get_if<LevelRequest>(&answer.work)) {
    again = co_await answerLevel(view, std::move(answer.reply), *level, keepAlive);
  } else if (const auto* upload = std::get_if<UploadRequest>(&answer.work)) {
    again = co_await answerUpload(view, *upload, keepAlive);
  } else {
    again = co_await send(std::move(answer.reply), keepAlive && !hasBody(view));
  }
  co_return again;
}

asio::awaitable<bool> HttpSession::answerLevel(const RequestView& request, Reply reply,
                                               const LevelRequest& level, bool keepAlive) {
  std::optional<LevelFile> file = services_.jobs.find(level);
  if (!file && reply.sendBody) {
    LevelAnswer answered = co_await waitForLevel(socket_, services_.jobs, level,
                                                 client_ ? client_->address() : nullptr);
    if (const auto* refusal = std::get_if<LevelRefusal>(&answered)) {
      if (*refusal == LevelRefusal::kGone) {
        reply.status = kClientGone;
        report(reply, false);
        co_return false;
      }
      co_return co_await send(refusedLevel(*refusal), keepAlive);
    }
    Result<LevelFile>& made = std::get<Result<LevelFile>>(answered);
    if (!made) {
      spdlog::error("{}: level {} cannot be made: {}", level.mesh->id, level.level,
                    made.error().text());
      co_return co_await send(failedLevel(made.error()), keepAlive);
    }
    file = std::move(*made);
  }
  if (file) {
    const bool sendBody = reply.sendBody;
    reply = rangeReply(request, std::move(reply), file->bytes, file->owner);
    reply.sendBody = sendBody;
  }
  co_return co_await send(std::move(reply), keepAlive);
}

asio::awaitable<bool> HttpSession::answerUpload(const RequestView& request,
                                                const UploadRequest& upload, bool keepAlive) {
  if (upload.kind == UploadRequest::Kind::kDelete) {
    Reply removed = co_await remove(upload);
    co_return co_await send(std::move(removed), keepAlive);
  }
  auto begun = services_.uploads->begin(upload);
  if (!begun) {
    begun.error().close = true;  // the body is not read
    co_return co_await send(std::move(begun.error()), false);
  }
  if (request.expect) {
    const bool sent = co_await write(kContinue, {});
    if (!sent) co_return false;
  }
  std::optional<Reply> refusal = co_await receiveBody(**begun, upload.bodyBytes);
  if (refusal) {
    begun->reset();
    refusal->close = true;
    co_return co_await send(std::move(*refusal), false);
  }
  std::optional<Reply> done = (*begun)->partial();
  if (!done) done = co_await finish(**begun);
  begun->reset();  // its place is free before the client hears of the end
  if (done) co_return co_await send(std::move(*done), keepAlive);
  Reply gone;
  gone.status = kClientGone;
  report(gone, false);
  co_return false;
}

asio::awaitable<std::optional<Reply>> HttpSession::receiveBody(Upload& upload,
                                                               std::uint64_t bytes) {
  Bytes piece(limits::kBodyPiece);
  while (bytes > 0) {
    std::size_t have = std::min<std::uint64_t>({buffer_.size(), bytes, piece.size()});
    std::copy_n(buffered().data(), have, piece.begin());
    buffer_.consume(have);
    const std::size_t wanted = std::min<std::uint64_t>(bytes, piece.size());
    error_code ec;
    const Deadline deadline(socket_, services_.timeouts.body);
    while (have < wanted && !ec && !deadline.passed()) {
      have += socket_.read({reinterpret_cast<char*>(piece.data()) + have, wanted - have}, ec);
      if (ec == asio::error::would_block) ec = co_await socket_.waitToRead();
    }
    if (std::optional<Reply> trouble = upload.append(ByteView(piece).first(have)))
      co_return trouble;
    if (have < wanted)
      co_return problem(408, "request-timeout",
                        "the request's body did not arrive, or not in time");
    bytes -= have;
  }
  co_return std::nullopt;
}

asio::awaitable<Reply> HttpSession::remove(const UploadRequest& upload) {
  auto start = [this, &upload, executor = socket_.get_executor()](auto handler) {
    asio::post(
        *services_.writers, [this, &upload, executor, handler = std::move(handler)]() mutable {
          Reply reply = services_.uploads->remove(upload);
          asio::post(executor, [handler = std::move(handler), reply = std::move(reply)]() mutable {
            handler(std::move(reply));
          });
        });
  };
  co_return co_await asio::async_initiate<const asio::use_awaitable_t<>, void(Reply)>(
      std::move(start), use_awaitable);
}

asio::awaitable<std::optional<Reply>> HttpSession::finish(Upload& upload) {
  std::stop_source stop;
  auto start = [this, &upload, &stop, executor = socket_.get_executor()](auto handler) {
    // while it is, the coroutine waits here, and with it the socket
    const auto pending = std::make_shared<bool>(true);
    watchForEnd(socket_, [pending] { return *pending; }, [&stop] { stop.request_stop(); });
    asio::post(*services_.checkers, [&upload, token = stop.get_token(), pending, executor,
                                     handler = std::move(handler)]() mutable {
      Reply reply = upload.finish(token);
      asio::post(executor,
                 [pending, handler = std::move(handler), reply = std::move(reply)]() mutable {
                   *pending = false;
                   handler(std::move(reply));
                 });
    });
  };
  Reply out = co_await asio::async_initiate<const asio::use_awaitable_t<>, void(Reply)>(
      std::move(start), use_awaitable);
  socket_.cancel();  // the watch, if it still stands
  if (stop.stop_requested()) co_return std::nullopt;
  co_return out;
}

asio::awaitable<bool> HttpSession::send(Reply reply, bool keepAlive) {
  keepAlive = keepAlive && !connection_->ending();
  reply.headers.emplace_back("X-Request-Id", trace_.id);
  if (!trace_.traceId.empty()) reply.headers.emplace_back("traceparent", trace_.traceparent());
  const std::string head = headerText(reply, keepAlive);
  ByteView body;
  if (const auto* text = std::get_if<std::string>(&reply.body)) body = viewOf(*text);
  if (const auto* view = std::get_if<ByteView>(&reply.body)) body = *view;
  if (!reply.sendBody) body = {};
  const bool sent =
      co_await write(head, body, body.size() >= limits::kLeastFromFile ? reply.file : std::nullopt);
  report(reply, sent);
  if (!sent) co_return false;
  if (!keepAlive) co_await linger();
  co_return keepAlive;
}

asio::awaitable<bool> HttpSession::write(std::string_view head, ByteView body,
                                         std::optional<FilePart> file) {
  sent_ = 0;
  // The head goes with the first bytes, but for much to somebody on this machine: its own packet
  // costs less than what follows lying across all of them.
  const bool headWaits = file && !(services_.unpaced && body.size() >= limits::kMaxFromFile);
  std::optional<Deadline> deadline;  // for a piece; most answers are taken at once
  for (std::size_t taken = 0; !head.empty() || sent_ < body.size();) {
    error_code ec;
    const ByteView rest = body.subspan(sent_);
    std::size_t count = 0;
    if (!head.empty() || !file) {
      const std::array<iovec, 2> parts = {iovec{const_cast<char*>(head.data()), head.size()},
                                          iovec{const_cast<std::uint8_t*>(rest.data()),
                                                std::min(rest.size(), limits::kWritePiece)}};
      count = socket_.write(
          std::span(parts).subspan(head.empty() ? 1 : 0, file || head.empty() ? 1 : 2), headWaits,
          ec);
    } else {
      count = socket_.writeFile({file->descriptor, file->offset + sent_},
                                rest.first(std::min(rest.size(), limits::kMaxFromFile)), ec);
    }
    const std::size_t ofHead = std::min(count, head.size());
    head.remove_prefix(ofHead);
    sent_ += count - ofHead;
    taken += count;
    if (deadline && taken >= limits::kWritePiece) deadline.reset(), taken = 0;
    if (ec == asio::error::would_block) {
      if (!deadline) deadline.emplace(socket_, services_.timeouts.write), taken = 0;
      ec = deadline->passed() ? asio::error::timed_out : co_await socket_.waitToWrite();
    }
    if (ec) co_return false;
  }
  co_return true;
}

void HttpSession::report(const Reply& reply, bool whole) {
  const auto time = Clock::now() - begun_;
  services_.metrics.countRequest(reply.status, sent_, time);
  if (services_.accessLog == nullptr) return;
  services_.accessLog->write({peer_, method_, target_, reply.status, sent_, time, whole}, trace_);
}

asio::awaitable<void> HttpSession::refuse(Reply reply) {
  reply.close = true;
  co_await send(std::move(reply), false);
}

/// Closing while bytes of the client's lie unread would reset the connection, and the answer might
/// be lost on its way.
asio::awaitable<void> HttpSession::linger() {
  socket_.finishSending();
  const Deadline deadline(socket_, limits::kLingerTime);
  error_code ec;
  for (std::size_t read = 0; !ec && read < limits::kLingerBytes && !deadline.passed();) {
    buffer_.clear();
    readSome(ec);
    read += buffer_.size();
    if (ec == asio::error::would_block) ec = co_await socket_.waitToRead();
  }
}

}  // namespace

asio::awaitable<void> serveHttp(asio::ip::tcp::socket socket, std::shared_ptr<const TlsContext> tls,
                                const Services& services, std::shared_ptr<Connection> connection,
                                std::unique_ptr<AddressLimits::Client> client) {
  HttpSession session(ClientSocket(std::move(socket), tls.get()), services, std::move(connection),
                      std::move(client));
  co_await session.run();
}

}  // namespace qtet
