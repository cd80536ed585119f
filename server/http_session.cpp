#include "server/http_session.h"

#include <spdlog/spdlog.h>
#include <sys/sendfile.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <boost/asio/async_result.hpp>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/read.hpp>
#include <boost/asio/redirect_error.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/parser.hpp>
#include <cerrno>
#include <limits>
#include <optional>

#include "server/deadline.h"
#include "server/http_gate.h"
#include "server/http_request.h"
#include "server/http_resource.h"
#include "server/level_wait.h"
#include "server/stream_session.h"

namespace qtet {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
using asio::redirect_error;
using asio::use_awaitable;
using beast::error_code;
using Parser = http::request_parser<http::empty_body>;
using Clock = std::chrono::steady_clock;

constexpr std::size_t kReadBytes = 4096;
constexpr std::string_view kContinue = "HTTP/1.1 100 Continue\r\n\r\n";

Reply tooLong() {
  return problem(431, "header-too-large",
                 "at most " + std::to_string(limits::kMaxHeaderBytes) + " bytes and " + std::to_string(limits::kMaxHeaderLines) +
                     " lines of request head are read");
}

Reply busy(unsigned status, std::string_view type, std::string_view detail, unsigned seconds) {
  Reply out = problem(status, type, detail);
  out.headers.emplace_back("Retry-After", std::to_string(seconds));
  return out;
}

/// Whether bytes follow the head. Unless they are read, what comes after them cannot be told from them, and the connection must end.
bool hasBody(const RequestView& request) {
  return request.contentLength && request.contentLength->find_first_not_of('0') != std::string_view::npos;
}

/// The answer to a head that Beast's parser does not take.
Reply answerToParseError(const error_code& ec) {
  if (ec == http::error::header_limit || ec == http::error::buffer_overflow) return tooLong();
  if (ec == http::error::bad_version) return problem(505, "version-not-supported", "this server speaks HTTP/1.1 and HTTP/1.0");
  return problem(400, "bad-request", "this is not HTTP: " + ec.message());
}

class HttpSession {
 public:
  HttpSession(beast::tcp_stream stream, const Services& services, std::shared_ptr<Connection> connection,
              std::unique_ptr<AddressLimits::Visitor> visitor)
      : stream_(std::move(stream)),
        services_(services),
        connection_(std::move(connection)),
        visitor_(std::move(visitor)),
        buffer_(limits::kMaxHeaderBytes) {
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
  void readSome(error_code& ec);
  /// The whole head parsed; nullopt: the connection has ended, or was refused.
  asio::awaitable<bool> readHead(Parser& parser);
  asio::awaitable<bool> becomeStream(Parser& parser);
  /// Answers one request; false: the connection is not to be used further.
  asio::awaitable<bool> answer(const RequestHeader& request, bool keepAlive);
  asio::awaitable<bool> answerLevel(const RequestView& request, Reply reply, bool keepAlive);
  asio::awaitable<bool> answerUpload(const RequestView& request, const UploadRequest& upload, bool keepAlive);
  /// Reads the body into the upload; the answer, if it ends before its time. A connection that is lost has none to send.
  asio::awaitable<std::optional<Reply>> receiveBody(Upload& upload, std::uint64_t bytes);
  asio::awaitable<Reply> elsewhere(std::move_only_function<Reply()> work);
  asio::awaitable<bool> send(Reply reply, bool keepAlive);
  asio::awaitable<bool> write(const std::string& head, ByteView body);
  asio::awaitable<bool> writeFile(const std::string& head, FilePart file, std::size_t bytes);
  asio::awaitable<void> refuse(Reply reply);
  asio::awaitable<void> linger();
  [[nodiscard]] std::string_view buffered() const { return {static_cast<const char*>(buffer_.data().data()), buffer_.size()}; }
  void report(const Reply& reply, bool whole);

  beast::tcp_stream stream_;
  const Services& services_;
  std::shared_ptr<Connection> connection_;
  std::unique_ptr<AddressLimits::Visitor> visitor_;
  beast::flat_buffer buffer_;
  bool idle_ = false;  // waits for a request that has not begun

  // Of the request under way, for its answer's headers, the figures and the log.
  RequestTrace trace_;
  std::string method_, target_;
  Clock::time_point begun_{};
  std::uint64_t sent_ = 0;
};

/// What has come, without waiting.
void HttpSession::readSome(error_code& ec) {
  if (!stream_.socket().non_blocking()) stream_.socket().non_blocking(true, ec);
  std::array<char, kReadBytes> bytes;
  const std::size_t count = stream_.socket().read_some(asio::buffer(bytes), ec);
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
      stream_.expires_never();
      const Deadline deadline(stream_, services_.timeouts.idle);
      idle_ = true;
      co_await stream_.socket().async_wait(asio::ip::tcp::socket::wait_read, redirect_error(use_awaitable, ec));
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
      refusal = problem(400, "bad-request", "this is not HTTP/1.1: a bare line end, a control byte, a folded line or no method");
    if (verdict == HttpGate::Verdict::kTooLong || buffer_.size() >= limits::kMaxHeaderBytes) refusal = tooLong();
    error_code ec;
    if (!deadline) {
      stream_.expires_never();
      deadline.emplace(stream_, services_.timeouts.header);
    }
    if (!refusal && !deadline->passed()) {
      const std::size_t room = std::min(kReadBytes, limits::kMaxHeaderBytes - buffer_.size());
      buffer_.commit(co_await stream_.async_read_some(buffer_.prepare(room), redirect_error(use_awaitable, ec)));
    }
    if (!refusal && deadline->passed()) refusal = problem(408, "request-timeout", "the request's head did not arrive in time");
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
  for (;;) {
    const bool begun = co_await waitForBytes();
    if (!begun) co_return;
    Parser parser;
    const bool whole = co_await readHead(parser);
    if (!whole) co_return;
    const RequestHeader& header = parser.get();
    const RequestView view = viewOf(header);
    trace_ = traceOf(view.requestId, view.traceparent);
    method_ = view.method;
    target_ = view.target;
    if (std::optional<Reply> refusal = refusalOf(header)) {
      co_await refuse(std::move(*refusal));
      co_return;
    }
    const bool keepAlive = parser.get().keep_alive();
    if (visitor_ && !visitor_->countRequest()) {
      const bool again = co_await send(busy(429, "too-many-requests", "this address asks too often; come back in a moment", 1), keepAlive && !hasBody(view));
      if (!again) co_return;
      continue;
    }
    if (services_.streams && isStreamHandshake(header)) {
      co_await becomeStream(parser);
      co_return;
    }
    const bool again = co_await answer(header, keepAlive);
    if (!again) co_return;
  }
}

asio::awaitable<bool> HttpSession::becomeStream(Parser& parser) {
  if (std::optional<Reply> refusal = handshakeRefusal(parser.get(), services_.allowedOrigins)) {
    co_await refuse(std::move(*refusal));
    co_return false;
  }
  connection_->onEnd({});
  const auto key = parser.get()[http::field::sec_websocket_key];
  StreamHandshake handshake{std::string(key.data(), key.size()), std::string(buffered())};
  // A coroutine of its own, so that what a request needed goes.
  const auto executor = stream_.get_executor();
  asio::co_spawn(executor, serveStream(stream_.release_socket(), std::move(handshake), services_.store, std::move(connection_), std::move(visitor_)),
                 [](const std::exception_ptr& thrown) {
                   if (thrown) spdlog::error("a stream ended by an exception");
                 });
  co_return true;
}

asio::awaitable<bool> HttpSession::answer(const RequestHeader& request, bool keepAlive) {
  const RequestView view = viewOf(request);
  Reply reply = services_.route(view);
  keepAlive = keepAlive && !reply.close;
  bool again = false;
  if (std::holds_alternative<LevelRequest>(reply.body)) {
    again = co_await answerLevel(view, std::move(reply), keepAlive);
  } else if (const auto* upload = std::get_if<UploadRequest>(&reply.body)) {
    again = co_await answerUpload(view, *upload, keepAlive);
  } else {
    again = co_await send(std::move(reply), keepAlive && !hasBody(view));
  }
  co_return again;
}

asio::awaitable<bool> HttpSession::answerLevel(const RequestView& request, Reply reply, bool keepAlive) {
  LevelRequest level = std::get<LevelRequest>(reply.body);
  std::optional<LevelFile> file = services_.jobs.find(level);
  if (!file && reply.sendBody) {
    stream_.expires_never();
    LevelAnswer answered = co_await waitForLevel(stream_.socket(), services_.jobs, level);
    if (const auto* refusal = std::get_if<LevelRefusal>(&answered)) {
      if (*refusal == LevelRefusal::kGone) {
        reply.status = kClientGone;
        report(reply, false);
        co_return false;
      }
      co_return co_await send(busy(503, "busy", "too many levels are being made; try again", limits::kRetryAfterSeconds), keepAlive);
    }
    Result<LevelFile>& made = std::get<Result<LevelFile>>(answered);
    if (!made) {
      spdlog::error("{}: level {} cannot be made: {}", level.mesh->id, level.level, made.error().text());
      co_return co_await send(problem(500, "internal", "the level cannot be made: " + made.error().text()), keepAlive);
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

asio::awaitable<bool> HttpSession::answerUpload(const RequestView& request, const UploadRequest& upload, bool keepAlive) {
  if (upload.kind == UploadRequest::Kind::kDelete) {
    Reply removed = co_await elsewhere([this, &upload] { return services_.uploads->remove(upload); });
    co_return co_await send(std::move(removed), keepAlive);
  }
  auto begun = services_.uploads->begin(upload);
  if (!begun) {
    begun.error().close = true;  // the body is not read
    co_return co_await send(std::move(begun.error()), false);
  }
  if (request.expect) {
    error_code ec;
    stream_.expires_after(services_.timeouts.write);
    co_await asio::async_write(stream_, asio::buffer(kContinue), redirect_error(use_awaitable, ec));
  }
  std::optional<Reply> refusal = co_await receiveBody(**begun, upload.bodyBytes);
  if (refusal) {
    begun->reset();
    refusal->close = true;
    co_return co_await send(std::move(*refusal), false);
  }
  Reply done = co_await elsewhere([&begun] { return (*begun)->finish(); });
  begun->reset();  // its place is free before the client hears of the end
  co_return co_await send(std::move(done), keepAlive);
}

asio::awaitable<std::optional<Reply>> HttpSession::receiveBody(Upload& upload, std::uint64_t bytes) {
  Bytes piece(limits::kBodyPiece);
  stream_.expires_never();
  while (bytes > 0) {
    std::size_t have = std::min<std::uint64_t>({buffer_.size(), bytes, piece.size()});
    std::copy_n(buffered().data(), have, piece.begin());
    buffer_.consume(have);
    const std::size_t wanted = std::min<std::uint64_t>(bytes, piece.size());
    error_code ec;
    Deadline deadline(stream_, services_.timeouts.body);
    if (have < wanted)
      have += co_await asio::async_read(stream_, asio::buffer(piece.data() + have, wanted - have), redirect_error(use_awaitable, ec));
    if (std::optional<Reply> trouble = upload.append(ByteView(piece).first(have))) co_return trouble;
    if (ec) co_return problem(408, "request-timeout", "the request's body did not arrive, or not in time");
    bytes -= have;
  }
  co_return std::nullopt;
}

asio::awaitable<Reply> HttpSession::elsewhere(std::move_only_function<Reply()> work) {
  auto start = [this, executor = stream_.get_executor(), work = std::move(work)](auto handler) mutable {
    asio::post(*services_.verifiers, [executor, work = std::move(work), handler = std::move(handler)]() mutable {
      Reply reply = work();
      asio::post(executor, [handler = std::move(handler), reply = std::move(reply)]() mutable { handler(std::move(reply)); });
    });
  };
  co_return co_await asio::async_initiate<const asio::use_awaitable_t<>, void(Reply)>(std::move(start), use_awaitable);
}

asio::awaitable<bool> HttpSession::send(Reply reply, bool keepAlive) {
  keepAlive = keepAlive && !connection_->ending();
  reply.headers.emplace_back("X-Request-Id", trace_.id);
  if (!trace_.traceId.empty()) reply.headers.emplace_back("traceparent", trace_.traceparent());
  const std::string head = headerText(reply, keepAlive);
  ByteView body;
  if (const auto* text = std::get_if<std::string>(&reply.body)) body = viewOf(*text);
  if (const auto* view = std::get_if<ByteView>(&reply.body)) body = *view;
  bool sent = false;
  if (reply.file && reply.sendBody && body.size() >= limits::kLeastFromFile) {
    sent = co_await writeFile(head, *reply.file, body.size());
  } else {
    sent = co_await write(head, reply.sendBody ? body : ByteView());
  }
  report(reply, sent);
  if (!sent) co_return false;
  if (!keepAlive) co_await linger();
  co_return keepAlive;
}

asio::awaitable<bool> HttpSession::write(const std::string& head, ByteView body) {
  sent_ = 0;
  asio::const_buffer first = asio::buffer(head);
  do {
    const ByteView piece = body.first(std::min(body.size(), limits::kWritePiece));
    body = body.subspan(piece.size());
    const std::array<asio::const_buffer, 2> buffers = {first, asio::const_buffer(piece.data(), piece.size())};
    error_code ec;
    stream_.expires_after(services_.timeouts.write);
    co_await asio::async_write(stream_, buffers, redirect_error(use_awaitable, ec));
    if (ec) co_return false;
    sent_ += piece.size();
    first = {};
  } while (!body.empty());
  co_return true;
}

/// The head and then the file's pages, which the kernel sends without copying them.
asio::awaitable<bool> HttpSession::writeFile(const std::string& head, FilePart file, std::size_t bytes) {
  sent_ = 0;
  const int socket = stream_.socket().native_handle();
  auto offset = static_cast<off_t>(file.offset);
  std::size_t headSent = 0;
  error_code ec;
  if (!stream_.socket().native_non_blocking()) stream_.socket().native_non_blocking(true, ec);
  stream_.expires_never();
  while (!ec && (headSent < head.size() || sent_ < bytes)) {
    const bool inHead = headSent < head.size();
    const ssize_t count = inHead ? ::send(socket, head.data() + headSent, head.size() - headSent, MSG_MORE | MSG_NOSIGNAL)
                                 : ::sendfile(socket, file.descriptor, &offset, std::min<std::size_t>(bytes - sent_, limits::kMostFromFile));
    if (count > 0) (inHead ? headSent : sent_) += static_cast<std::size_t>(count);
    if (count > 0 || (count < 0 && errno == EINTR)) continue;
    if (count == 0 || errno != EAGAIN) co_return false;  // the file has become shorter, or the client has gone
    const Deadline deadline(stream_, services_.timeouts.write);
    co_await stream_.socket().async_wait(asio::ip::tcp::socket::wait_write, redirect_error(use_awaitable, ec));
  }
  co_return !ec;
}

void HttpSession::report(const Reply& reply, bool whole) {
  const auto time = Clock::now() - begun_;
  services_.metrics.countRequest(reply.status, sent_, time);
  if (services_.accessLog == nullptr) return;
  error_code ec;
  const auto peer = stream_.socket().remote_endpoint(ec);
  const std::string client = ec ? "" : peer.address().to_string();
  services_.accessLog->write({client, method_, target_, reply.status, sent_, time, whole}, trace_);
}

asio::awaitable<void> HttpSession::refuse(Reply reply) {
  reply.close = true;
  co_await send(std::move(reply), false);
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

asio::awaitable<void> serveHttp(beast::tcp_stream stream, const Services& services, std::shared_ptr<Connection> connection,
                                std::unique_ptr<AddressLimits::Visitor> visitor) {
  HttpSession session(std::move(stream), services, std::move(connection), std::move(visitor));
  co_await session.run();
}

}  // namespace qtet
