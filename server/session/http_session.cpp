#include "server/session/http_session.h"

#include <spdlog/spdlog.h>

#include <boost/asio/co_spawn.hpp>
#include <chrono>
#include <optional>

#include "proto/text_bytes.h"
#include "server/http/deadline.h"
#include "server/http/http_resource.h"
#include "server/routes/access_routes.h"
#include "server/session/answer_work.h"
#include "server/session/http_input.h"
#include "server/session/http_output.h"
#include "server/session/http_request.h"
#include "server/session/preflight.h"
#include "server/session/request_report.h"
#include "server/session/tls_greeting.h"
#include "server/stream/stream_session.h"
#include "server/wire/charge.h"
#include "server/wire/http_limits.h"
#include "server/wire/peer.h"
#include "server/wire/trusted_proxies.h"
#include "server/wire/turns.h"

namespace qtet {
namespace {

namespace asio = boost::asio;
namespace http = boost::beast::http;
using Parser = HttpInput::Parser;

/// A browser that has read it asks by https alone for a year (RFC 6797).
constexpr const char* kStrictTransport = "max-age=31536000";

/// Whether bytes follow the head. Unless the server reads them, it cannot distinguish them from the
/// next request, and the connection must end.
bool hasBody(const RequestView& request) {
  return request.contentLength &&
         request.contentLength->find_first_not_of('0') != std::string_view::npos;
}

class HttpSession {
 public:
  HttpSession(Peer peer, const Services& services, std::optional<asio::ip::address> proxy)
      : peer_(std::move(peer)),
        services_(services),
        input_(peer_, services.timeouts),
        // asked now: who leaves at once has no address afterwards
        report_(services.metrics, services.accessLog, services.access,
                services.accessLog != nullptr ? peer_.socket.peer() : ""),
        proxies_(proxy ? services.proxies : nullptr),
        proxy_(std::move(proxy)) {}

  asio::awaitable<void> run();

 private:
  /// Reads for whom a proxy has connected; false: it does not say so as it has to.
  asio::awaitable<bool> greetProxy();
  [[nodiscard]] bool asksProxyOnce() const {
    return proxies_ != nullptr && proxies_->header == ProxyHeader::kProxyProtocol;
  }
  /// From now on the connection is that client's; nullopt: the proxy's own. False: the client has
  /// as many as it may have.
  bool belongsTo(std::optional<asio::ip::address> client);
  asio::awaitable<bool> shakeHands();
  /// Lets other connections of the thread have their turn.
  asio::awaitable<void> giveWay() {
    co_await takeTurn(peer_.socket.get_executor(), peer_.client.get());
  }
  /// Reads a request and answers it; false: the connection is not to be used further. A coroutine
  /// of its own, so that a silent client holds none of what a request needs. `pipelined`: it had
  /// come before the last one was answered.
  asio::awaitable<bool> serveRequest(bool pipelined);
  /// The answer to a request if nothing of what it asks for matters.
  /// `placed`: the client has a place among those of its address.
  std::optional<Reply> earlyAnswer(const RequestHeader& header, const RequestView& view,
                                   bool placed);
  asio::awaitable<bool> becomeStream(Parser& parser);
  /// Answers one request; false: the connection is not to be used further.
  asio::awaitable<bool> answer(const RequestHeader& request, const RequestView& view,
                               bool keepAlive);
  /// The head in one buffer with `body` behind it.
  [[nodiscard]] std::string headOf(const Reply& reply, bool keepAlive, ByteView body) const;
  asio::awaitable<bool> send(Reply reply, bool keepAlive);
  asio::awaitable<void> refuse(Reply reply);

  Peer peer_;
  const Services& services_;
  HttpInput input_;
  RequestReport report_;
  const TrustedProxies* proxies_;           // nullptr: the client is the peer
  std::optional<asio::ip::address> proxy_;  // its own address
  bool headOnly_ = false;  // the request under way is a HEAD: its answer has no body
  bool isOld_ = false;     // it is one of HTTP/1.0
};

bool HttpSession::belongsTo(std::optional<asio::ip::address> client) {
  peer_.client.reset();
  if (!client) return true;
  peer_.client = services_.addresses->enter(*client);
  if (services_.accessLog != nullptr) {
    if (asksProxyOnce())
      report_.setPeer(client->to_string());
    else
      report_.setClient(client->to_string());
  }
  return peer_.client != nullptr;
}

asio::awaitable<bool> HttpSession::greetProxy() {
  if (!asksProxyOnce()) co_return true;
  std::optional<ProxyHead> head;
  {
    const Deadline deadline(peer_.socket, services_.timeouts.header);
    const IdleScope idle(peer_);
    head = co_await peer_.socket.takeProxyHead();
  }
  co_return head&& belongsTo(head->client);
}

asio::awaitable<bool> HttpSession::shakeHands() {
  if (!peer_.socket.isTls()) co_return true;
  const bool done = co_await shakeHandsInTurn(peer_, services_);
  if (!done && peer_.socket.becomePlainForPlainHttp())
    co_await refuse(
        problem(400, "bad-request", "this port speaks TLS; the address begins with https://"));
  co_return done;
}

asio::awaitable<void> HttpSession::run() {
  const bool known = co_await greetProxy();
  if (!known) co_return;
  const bool greeted = co_await shakeHands();
  if (!greeted) co_return;
  for (bool first = true;; first = false) {
    const HttpInput::Begun begun = co_await input_.waitForRequest();
    if (begun == HttpInput::Begun::kNot) co_return;
    const bool again = co_await serveRequest(!first && begun == HttpInput::Begun::kAtOnce);
    if (!again) co_return;
  }
}

asio::awaitable<bool> HttpSession::serveRequest(bool pipelined) {
  report_.begin();
  isOld_ = false;
  Parser parser;
  auto head = co_await input_.readHead(parser);
  headOnly_ =
      head ? parser.get().method() == http::verb::head : input_.buffered().starts_with("HEAD ");
  if (!head) {
    if (head.error()) co_await refuse(std::move(*head.error()));
    co_return false;
  }
  joinLists(parser.get());
  isOld_ = parser.get().version() == 10;
  const RequestView view = viewOf(parser.get());
  const bool placed = proxies_ == nullptr || asksProxyOnce() ||
                      belongsTo(forwardedClientOf(parser.get(), *proxies_, *proxy_));
  {
    const Charge charge(peer_.client.get());
    report_.identify(view);
  }
  if (pipelined || owesTurn(peer_.client.get())) co_await giveWay();
  const bool keepAlive = parser.get().keep_alive();
  bool again = false;
  if (std::optional<Reply> early = earlyAnswer(parser.get(), view, placed)) {
    again = co_await send(std::move(*early), keepAlive);
  } else if (services_.streams && isStreamHandshake(parser.get())) {
    co_await becomeStream(parser);
  } else {
    again = co_await answer(parser.get(), view, keepAlive);
  }
  if (proxies_ != nullptr && !asksProxyOnce()) peer_.client.reset();  // the next may be another's
  co_return again;
}

std::optional<Reply> HttpSession::earlyAnswer(const RequestHeader& header, const RequestView& view,
                                              bool placed) {
  if (std::optional<Reply> refusal = refusalOf(header)) {
    refusal->close = true;
    return refusal;
  }
  if (!isReading(header.method()))
    if (std::optional<Reply> refusal = originRefusal(header, services_.allowedOrigins))
      return refusal;
  const auto now = AddressLimits::Clock::now();
  if (placed && (!peer_.client || peer_.client->countRequest(now))) return std::nullopt;
  Reply out =
      problem(429, "too-many-requests", "this address asks too often; come back in a moment");
  out.refusal = !placed                        ? Refusal::kPlaces
                : peer_.client->overdrawn(now) ? Refusal::kCredit
                                               : Refusal::kRate;
  out.headers.add("Retry-After", "1");
  out.close = hasBody(view);
  return out;
}

asio::awaitable<bool> HttpSession::becomeStream(Parser& parser) {
  if (std::optional<Reply> refusal = originRefusal(parser.get(), services_.allowedOrigins)) {
    co_await refuse(std::move(*refusal));
    co_return false;
  }
  if (std::optional<Reply> refusal = handshakeRefusal(parser.get())) {
    co_await refuse(std::move(*refusal));
    co_return false;
  }
  std::expected<MayRead, Reply> mayRead = admitStream(viewOf(parser.get()), services_.access);
  if (!mayRead) {
    co_await refuse(std::move(mayRead.error()));
    co_return false;
  }
  const auto key = parser.get()[http::field::sec_websocket_key];
  StreamHandshake handshake{std::string(key.data(), key.size()),
                            std::string(input_.buffered()),
                            std::move(*mayRead),
                            services_.timeouts.silence,
                            services_.timeouts.write,
                            services_.unpaced,
                            report_.streamRequest()};
  // A coroutine of its own, so that what a request needed goes.
  const auto executor = peer_.socket.get_executor();
  asio::co_spawn(executor,
                 serveStream(std::move(peer_), std::move(handshake), services_.store,
                             services_.metrics, services_.accessLog),
                 [](const std::exception_ptr& thrown) {
                   if (thrown) spdlog::error("a stream ended by an exception");
                 });
  co_return true;
}

asio::awaitable<bool> HttpSession::answer(const RequestHeader& request, const RequestView& view,
                                          bool keepAlive) {
  Answer answer = [&] {
    const Charge charge(peer_.client.get(), &services_.metrics, report_.route());
    return services_.route(view);
  }();
  answerForOrigin(answer.reply, request, services_.allowedOrigins);
  if (std::holds_alternative<std::monostate>(answer.work))
    co_return co_await send(std::move(answer.reply), keepAlive && !hasBody(view));
  const bool readsBody = std::holds_alternative<UploadRequest>(answer.work);
  std::optional<Reply> reply = co_await workOn(std::move(answer), view, peer_, input_, services_);
  report_.received(input_.takeBodyBytes());
  if (!reply) reply = Reply{.status = kClientGone, .headers = {}, .body = {}};
  co_return co_await send(std::move(*reply), keepAlive && (readsBody || !hasBody(view)));
}

std::string HttpSession::headOf(const Reply& reply, bool keepAlive, ByteView body) const {
  constexpr std::size_t kFurther = 160;  // the status line, Date, Content-Length, Connection
  std::string out;
  out.reserve(reply.headers.text().size() + kFurther + body.size());
  appendHead(out, reply,
             !keepAlive ? Afterwards::kCloses
             : isOld_   ? Afterwards::kKept
                        : Afterwards::kStays);
  out.append(body.begin(), body.end());
  return out;
}

asio::awaitable<bool> HttpSession::send(Reply reply, bool keepAlive) {
  if (reply.status == kClientGone) {
    report_.end(reply.status, 0, false);
    co_return false;
  }
  keepAlive = keepAlive && !reply.close && !peer_.connection->ending();
  if (peer_.socket.isTls()) reply.headers.add("Strict-Transport-Security", kStrictTransport);
  report_.addHeaders(reply);
  ByteView body;
  if (const auto* text = std::get_if<std::string>(&reply.body)) body = viewOf(*text);
  if (const auto* view = std::get_if<ByteView>(&reply.body)) body = *view;
  if (!reply.sendBody || headOnly_) body = {};
  if (body.size() < limits::kMinFromFile) reply.file.reset();
  const bool together = body.size() <= limits::kMaxWithHead;
  const std::string head = headOf(reply, keepAlive, together ? body : ByteView());
  const Sent sent = co_await sendReply(
      peer_.socket, {head, together ? body.size() : 0, together ? ByteView() : body, reply.file},
      services_.timeouts.write, services_.unpaced);
  report_.end(reply.status, sent.bytes, sent.whole, reply.refusal);
  if (!sent.whole) co_return false;
  if (!keepAlive) {
    peer_.socket.finishSending();
    co_await input_.drain();
  }
  co_return keepAlive;
}

asio::awaitable<void> HttpSession::refuse(Reply reply) {
  reply.close = true;
  co_await send(std::move(reply), false);
}

}  // namespace

asio::awaitable<void> serveHttp(asio::ip::tcp::socket socket, std::shared_ptr<const TlsContext> tls,
                                const Services& services, std::shared_ptr<Connection> connection,
                                std::unique_ptr<AddressLimits::Client> client,
                                std::optional<asio::ip::address> proxy) {
  HttpSession session(
      Peer{ClientSocket(std::move(socket), tls.get()), std::move(connection), std::move(client)},
      services, std::move(proxy));
  co_await session.run();
}

}  // namespace qtet
