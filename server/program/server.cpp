#include <utility>  // before any Asio header: 1.74 uses std::exchange without it

#include "server/program/server.h"

#include <netinet/tcp.h>
#include <spdlog/spdlog.h>
#include <sys/socket.h>

#include <algorithm>
#include <atomic>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/redirect_error.hpp>
#include <boost/asio/signal_set.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/thread_pool.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <cassert>
#include <chrono>
#include <csignal>
#include <exception>
#include <functional>
#include <thread>
#include <vector>

#include "server/http/upload_limits.h"
#include "server/routes/http_router.h"
#include "server/session/http_session.h"
#include "server/store/free_disk.h"
#include "server/store/kept_points.h"
#include "server/store/store_limits.h"
#include "server/wire/connection_limits.h"
#include "server/wire/handshakes.h"
#include "server/wire/process_figures.h"

namespace qtet {
namespace {

namespace asio = boost::asio;
using asio::ip::tcp;
using boost::system::error_code;

/// One thread and its connections. A context a thread needs no strands, and was a fifth faster than
/// two threads on one context.
struct Lane {
  asio::io_context context{1};
  asio::executor_work_guard<asio::io_context::executor_type> work = asio::make_work_guard(context);
};

/// Selects congestion control without pacing for all accepted connections. False: the system's
/// choice stays. BBR would send each 64 KB by a timer of its own. Between two programs of one
/// machine (a proxy in front of this one, say) that is most of the cost of sending.
bool endPacing(tcp::acceptor& on) {
  constexpr std::string_view kReno = "reno";  // there in every kernel, and allowed to everybody
  return ::setsockopt(on.native_handle(), IPPROTO_TCP, TCP_CONGESTION, kReno.data(),
                      kReno.size()) == 0;
}

/// Answers a connection for which there is no place; what does not fit into an empty socket's
/// buffer is not waited for.
void turnAway(tcp::socket socket, unsigned status, std::string_view type, std::string_view detail) {
  Reply busy = problem(status, type, detail);
  busy.headers.add("Retry-After", std::to_string(limits::kRetryAfterSeconds));
  std::string text;
  appendHead(text, busy, Afterwards::kCloses);
  text += std::get<std::string>(busy.body);
  error_code ec;
  socket.non_blocking(true, ec);
  if (!ec) socket.write_some(asio::buffer(text), ec);
}

Workers workersOf(asio::thread_pool& pool) {
  return [&pool](std::move_only_function<void()> work) { asio::post(pool, std::move(work)); };
}

void logEnd(const std::exception_ptr& thrown) {
  if (!thrown) return;
  try {
    std::rethrow_exception(thrown);
  } catch (const std::exception& e) {
    spdlog::error("a connection ended by an exception: {}", e.what());
  }
}

}  // namespace

// The members' order is the order of their lives. Connections outlast the lanes that hold their
// coroutines. The jobs end first, since their last handler may still be on its way into a lane.
struct Server::State {
  State(const MeshStore& meshes, const ViewerFiles& viewer, ServerOptions given)
      : store(meshes),
        options(std::move(given)),
        uploads(meshes, options.uploads),
        router(meshes, viewer, options.adminHost ? nullptr : &admin,
               options.access != nullptr ? std::optional<Writing>({*options.access, uploads})
                                         : std::nullopt,
               options.frameAncestors),
        lanes(std::max<std::size_t>(options.threads, 1)) {}

  asio::awaitable<void> acceptConnections(tcp::acceptor& acceptor, const Services& services);
  void handOver(tcp::socket socket, const tcp::endpoint& peer, asio::io_context& context,
                const Services& services);
  /// For connections that `whose` answers.
  [[nodiscard]] Status listen(tcp::acceptor& acceptor, Services& whose, const std::string& host,
                              std::uint16_t port);
  [[nodiscard]] std::vector<Metrics::Figure> figures() const;
  /// Why new work is not welcome; "": it is.
  [[nodiscard]] std::string_view unready() {
    if (draining || ending) return "the server is ending";
    return options.readyEarly || store.catalogue()->named ? ""
                                                          : "the folder's names are not known yet";
  }
  void end();
  void drain();
  void stopLanes() {
    for (Lane& lane : lanes) lane.context.stop();
  }
  void watchSignals();
  [[nodiscard]] asio::io_context& mainContext() { return lanes.front().context; }
  [[nodiscard]] LevelJobs::Maker maker() const {
    if (options.decoders == nullptr) return options.makeLevel;
    return [from = options.decoders](const LevelRequest& request, const std::stop_token& stop) {
      return from->level(request, stop);
    };
  }

  const MeshStore& store;
  ServerOptions options;
  Metrics metrics;
  std::atomic<bool> draining = false, ending = false;
  AdminRoutes admin{metrics, [this] { return unready(); }, [this] { return figures(); }};
  Uploads uploads;
  Router router;
  Connections connections{options.maxConnections};
  Handshakes handshakes{{.most = options.maxHandshakes,
                         .ofAddress = options.maxHandshakesPerAddress,
                         .patience = options.timeouts.handshake}};
  AddressLimits addresses{{.connections = options.maxConnectionsPerAddress,
                           .requestsPerSecond = options.maxRequestsPerSecond,
                           .owed = options.maxOwedTime}};
  std::vector<Lane> lanes;
  tcp::acceptor acceptor{mainContext()};
  tcp::acceptor adminAcceptor{mainContext()};
  asio::steady_timer grace{mainContext()}, drained{mainContext()};
  asio::signal_set signals{mainContext()};
  LevelJobs jobs{{limits::kLevelThreads, limits::kMaxLevelJobs, options.cache, maker(),
                  options.maxLevelsPerAddress}};
  KeptPoints points;
  LevelJobs pointJobs{{limits::kPointThreads, limits::kMaxPointJobs, &points, maker(),
                       options.maxLevelsPerAddress}};
  asio::thread_pool writers{limits::kWriteThreads}, checkers{limits::kCheckThreads}, describers{1};
  Services services{.store = store,
                    .route = [this](const RequestView& request) { return router.route(request); },
                    .jobs = jobs,
                    .pointJobs = pointJobs,
                    .maxLevelBytes = options.maxLevelBytes,
                    .metrics = metrics,
                    .accessLog = options.accessLog,
                    .timeouts = options.timeouts,
                    .uploads = &uploads,
                    .writers = workersOf(writers),
                    .checkers = workersOf(checkers),
                    .describers = workersOf(describers),
                    .access = options.access,
                    .allowedOrigins = &options.allowedOrigins,
                    .handshakes = &handshakes,
                    .addresses = &addresses,
                    .proxies = options.proxies.networks.empty() ? nullptr : &options.proxies};
  Services adminServices{
      .store = store,
      .route = [this](const RequestView& request) { return routeAdmin(admin, request); },
      .streams = false,
      .jobs = jobs,
      .pointJobs = pointJobs,
      .maxLevelBytes = options.maxLevelBytes,
      .metrics = metrics,
      .accessLog = options.accessLog,
      .timeouts = options.timeouts};
};

asio::awaitable<void> Server::State::acceptConnections(tcp::acceptor& from, const Services& whose) {
  asio::steady_timer rest(mainContext());
  bool failing = false;
  std::optional<std::chrono::steady_clock::time_point> told;
  for (std::size_t next = 0; !ending; next = (next + 1) % lanes.size()) {
    asio::io_context& context = lanes[next].context;
    tcp::socket socket(context);
    error_code ec;
    tcp::endpoint peer;  // by accept() itself: a client that has gone has none afterwards
    co_await from.async_accept(socket, peer, asio::redirect_error(asio::use_awaitable, ec));
    if (!ec) {
      failing = false;
      handOver(std::move(socket), peer, context, whose);
    } else if (!ending && ec != asio::error::operation_aborted) {
      const auto now = std::chrono::steady_clock::now();
      if (!told || now - *told >= limits::kAcceptWarningInterval) {
        spdlog::warn("connections cannot be accepted: {}; they wait", ec.message());
        told = now;
      }
      rest.expires_after(std::exchange(failing, true) ? limits::kAcceptRest
                                                      : limits::kFirstAcceptRest);
      co_await rest.async_wait(asio::redirect_error(asio::use_awaitable, ec));
    }
  }
}

void Server::State::handOver(tcp::socket socket, const tcp::endpoint& peer,
                             asio::io_context& context, const Services& whose) {
  const bool ofOperators = &whose == &adminServices;
  const bool ofProxy = whose.proxies != nullptr && whose.proxies->networks.contains(peer.address());
  const bool bounded = !ofOperators && !ofProxy;
  std::unique_ptr<AddressLimits::Client> client =
      bounded ? addresses.enter(peer.address()) : nullptr;
  std::shared_ptr<Connection> connection =
      client || !bounded ? connections.enter(context.get_executor()) : nullptr;
  if (!connection) {
    metrics.countRefusedConnection();
    // a handshake costs more than there is for who is turned away
    if (options.tls != nullptr && !ofOperators) return;
    if (!client && bounded)
      return turnAway(std::move(socket), 429, "too-many-requests",
                      "too many connections from this address; close some");
    return turnAway(std::move(socket), 503, "busy", "too many connections; try again");
  }
  metrics.countConnection();
  auto tls = options.tls != nullptr && !ofOperators ? options.tls->now() : nullptr;
  // Posted first: co_spawn would begin the coroutine on this thread.
  asio::post(context,
             [&whose, socket = std::move(socket), tls = std::move(tls),
              connection = std::move(connection), client = std::move(client),
              proxy = ofProxy ? std::optional(peer.address()) : std::nullopt, &context]() mutable {
               asio::co_spawn(context,
                              serveHttp(std::move(socket), std::move(tls), whose,
                                        std::move(connection), std::move(client), proxy),
                              logEnd);
             });
}

std::vector<Metrics::Figure> Server::State::figures() const {
  LevelJobCounts levels = jobs.counts();
  levels += pointJobs.counts();
  const DecoderCounts decoders =
      options.decoders != nullptr ? options.decoders->counts() : DecoderCounts();
  const Handshakes::Counts hands = handshakes.counts();
  const CataloguePointer catalogue = store.catalogue();
  const auto gauge = [](const char* name, const char* help, auto value) {
    return Metrics::Figure{name, help, false, static_cast<double>(value)};
  };
  const auto counter = [](const char* name, const char* help, auto value) {
    return Metrics::Figure{name, help, true, static_cast<double>(value)};
  };
  const auto cache = [](const char* labels, auto bytes) {
    return Metrics::Figure{"cache_bytes",
                           "Bytes that are kept so that they need not be made again.", false,
                           static_cast<double>(bytes), labels};
  };
  std::vector<Metrics::Figure> out = processFigures();
  if (options.tls != nullptr)
    out.push_back(gauge("tls_certificate_expiry_timestamp_seconds",
                        "When the certificate ends, since 1970.",
                        std::chrono::system_clock::to_time_t(options.tls->now()->expires())));
  const std::vector<Metrics::Figure> ours = {
      gauge("disk_free_bytes", "Bytes that may still be written where the meshes lie.",
            freeDiskBytes(store.folder())),
      gauge("uploads_open", "Uploads under way.", uploads.active()),
      gauge("uploads_part_bytes", "Bytes of uploads that are not whole.", uploads.partBytes()),
      cache("{cache=\"pages\"}", router.pageBytes()),
      cache("{cache=\"levels\"}", options.cache != nullptr ? options.cache->bytes() : 0),
      cache("{cache=\"points\"}", points.bytes()),
      cache("{cache=\"copies\"}", bytesOfCopies()),
      gauge("uploads_checking", "Uploads whose logs are being decoded.", uploads.checking()),
      counter("uploads_published_total", "Logs that were uploaded and published.",
              uploads.published()),
      gauge("connections_open", "Connections that are open, HTTP and WebSocket.",
            connections.open()),
      gauge("tls_handshakes_open", "TLS handshakes under way.", hands.open),
      gauge("tls_handshakes_waiting", "Connections that wait for the place of a TLS handshake.",
            hands.waiting),
      counter("tls_handshakes_displaced_total",
              "TLS handshakes given up, unfinished, for others that waited.", hands.displaced),
      gauge("meshes", "Meshes that are served.", catalogue->meshes.size()),
      gauge("meshes_unread", "Files of the folder that nobody has looked into yet.",
            catalogue->unread.size()),
      gauge("meshes_refused", "Files that are not served because they are damaged.",
            catalogue->refused.size()),
      gauge("levels_wanted", "Requests that wait for a level.", levels.wanted),
      gauge("levels_waiting", "Levels that wait for being made.", levels.waiting),
      gauge("levels_running", "Levels that are being made.", levels.running),
      counter("levels_made_total", "Levels made.", levels.made),
      counter("levels_found_total", "Levels that were kept from before.", levels.found),
      counter("levels_cancelled_total", "Levels that nobody waited for any more.",
              levels.cancelled),
      counter("levels_refused_total", "Levels refused because there were too many.",
              levels.refused),
      counter("levels_failed_total", "Levels that could not be made.", levels.failed),
      gauge("decoders_running", "Processes that decode a level or check a log.", decoders.running),
      counter("decoders_lost_total", "Such processes that crashed or were ended at their limits.",
              decoders.lost)};
  out.insert(out.end(), ours.begin(), ours.end());
  return out;
}

void Server::State::drain() {
  if (draining.exchange(true) || options.drain.count() == 0) return end();
  spdlog::info("not ready any more; the end begins in {} s",
               std::chrono::duration_cast<std::chrono::seconds>(options.drain).count());
  drained.expires_after(options.drain);
  drained.async_wait([this](error_code cancelled) {
    if (!cancelled && !ending) end();
  });
}

void Server::State::end() {
  drained.cancel();
  if (ending) return stopLanes();  // asked twice: at once
  ending = true;
  spdlog::info("ending; responses under way have {} s",
               std::chrono::duration_cast<std::chrono::seconds>(options.timeouts.grace).count());
  error_code ec;
  acceptor.close(ec);
  adminAcceptor.close(ec);
  grace.expires_after(options.timeouts.grace);
  grace.async_wait([this](error_code cancelled) {
    if (cancelled) return;
    spdlog::warn("some connections did not end in time and were cut");
    stopLanes();
  });
  connections.endAll([this] { asio::post(mainContext(), [this] { stopLanes(); }); });
}

void Server::State::watchSignals() {
  for (const int signal : {SIGINT, SIGTERM}) signals.add(signal);
  if (options.reload) signals.add(SIGHUP);
  if (options.reopenLog) signals.add(SIGUSR1);
  auto wait = std::make_shared<std::function<void()>>();
  *wait = [this, weak = std::weak_ptr(wait)] {
    signals.async_wait([this, wait = weak.lock()](error_code ec, int signal) {
      if (ec) return;
      switch (signal) {
        case SIGHUP: options.reload(); break;
        case SIGUSR1: options.reopenLog(); break;
        default: drain();
      }
      (*wait)();
    });
  };
  (*wait)();
}

Server::Server(const MeshStore& store, const ViewerFiles& viewer, ServerOptions options)
    : state_(std::make_unique<State>(store, viewer, std::move(options))) {}

/// Connections that outlived the grace time go with the lanes; the last of them must not call into
/// what is half gone. Their checks end first: a pool waits for what runs in it.
Server::~Server() {
  state_->connections.endAll({});
  state_->uploads.stopChecks();
}

Status Server::State::listen(tcp::acceptor& on, Services& whose, const std::string& host,
                             std::uint16_t port) {
  const auto refused = [&](const error_code& ec) {
    return fail(ErrorCode::kIo, "cannot listen on " + host + ":" + std::to_string(port) + ": " +
                                    ec.message() + "; choose another --host or --port");
  };
  error_code ec;
  tcp::resolver resolver(mainContext());
  const auto found = resolver.resolve(host, std::to_string(port), tcp::resolver::passive, ec);
  if (ec) return refused(ec);
  const tcp::endpoint endpoint = *found.begin();
  on.open(endpoint.protocol(), ec);
  if (!ec) on.set_option(tcp::acceptor::reuse_address(true), ec);
  // Without this, Asio waits for the next client if one left before it was accepted, even though
  // others are waiting already.
  if (!ec) on.set_option(tcp::acceptor::enable_connection_aborted(true), ec);
  if (!ec) on.set_option(tcp::no_delay(true), ec);  // what is accepted inherits it (tcp(7))
  if (!ec) whose.unpaced = endpoint.address().is_loopback() && endPacing(on);
  if (!ec) on.bind(endpoint, ec);
  if (!ec) on.listen(tcp::acceptor::max_listen_connections, ec);
  if (ec) return refused(ec);
  return {};
}

Status Server::listen() {
  const ServerOptions& options = state_->options;
  if (Status status =
          state_->listen(state_->acceptor, state_->services, options.host, options.port);
      !status)
    return status;
  if (Status status = options.adminHost
                          ? state_->listen(state_->adminAcceptor, state_->adminServices,
                                           *options.adminHost, options.adminPort)
                          : Status();
      !status)
    return status;
  // from here on; they are obeyed once run() runs
  if (options.endOnSignals) state_->watchSignals();
  return {};
}

std::uint16_t Server::adminPort() const {
  assert(state_->adminAcceptor.is_open());
  return state_->adminAcceptor.local_endpoint().port();
}

std::uint16_t Server::port() const {
  assert(state_->acceptor.is_open());
  return state_->acceptor.local_endpoint().port();
}

std::string Server::url() const {
  assert(state_->acceptor.is_open());
  const tcp::endpoint at = state_->acceptor.local_endpoint();
  const std::string host = at.address().to_string();
  const std::string scheme = state_->options.tls != nullptr ? "https://" : "http://";
  return scheme + (at.address().is_v6() ? "[" + host + "]" : host) + ":" +
         std::to_string(at.port()) + "/";
}

void Server::run() {
  assert(state_->acceptor.is_open());
  std::signal(SIGPIPE, SIG_IGN);  // sendfile knows no MSG_NOSIGNAL
  if (state_->options.access != nullptr) state_->uploads.sweep();
  asio::co_spawn(state_->mainContext(),
                 state_->acceptConnections(state_->acceptor, state_->services), logEnd);
  if (state_->options.adminHost)
    asio::co_spawn(state_->mainContext(),
                   state_->acceptConnections(state_->adminAcceptor, state_->adminServices), logEnd);
  std::vector<std::jthread> others;
  for (std::size_t i = 1; i < state_->lanes.size(); ++i)
    others.emplace_back([&lane = state_->lanes[i]] { lane.context.run(); });
  state_->mainContext().run();
}

void Server::drain() {
  asio::post(state_->mainContext(), [this] { state_->drain(); });
}

void Server::stop() {
  asio::post(state_->mainContext(), [this] {
    if (!state_->ending) state_->end();
  });
}

}  // namespace qtet
