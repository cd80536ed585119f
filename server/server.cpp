#include <utility>  // before any Asio header: 1.74 uses std::exchange without it

#include "server/server.h"

#include <netinet/tcp.h>
#include <spdlog/spdlog.h>
#include <sys/socket.h>

#include <algorithm>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/redirect_error.hpp>
#include <boost/asio/signal_set.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <chrono>
#include <csignal>
#include <exception>
#include <functional>
#include <thread>
#include <vector>

#include "server/http_session.h"

namespace qtet {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
using asio::ip::tcp;
using boost::system::error_code;

/// One thread and its connections. A context a thread needs no strands, and was a fifth faster than two threads on one context.
struct Lane {
  asio::io_context context{1};
  asio::executor_work_guard<asio::io_context::executor_type> work = asio::make_work_guard(context);
};

/// Bytes that the kernel may hold unsent: so a superseded stream stops soon, and a stalled client costs 178 KB instead of megabytes.
constexpr int kUnsentBytes = 128 << 10;

void configure(tcp::socket& socket) {
  error_code ec;
  socket.set_option(tcp::no_delay(true), ec);
  (void)::setsockopt(socket.native_handle(), IPPROTO_TCP, TCP_NOTSENT_LOWAT, &kUnsentBytes, sizeof(kUnsentBytes));
}

/// Answers a connection for which there is no place; what does not fit into an empty socket's buffer is not waited for.
void turnAway(tcp::socket socket) {
  Reply busy = problem(503, "busy", "too many connections; try again");
  busy.headers.emplace_back("Retry-After", std::to_string(limits::kRetryAfterSeconds));
  const std::string text = headerText(busy, false) + std::get<std::string>(busy.body);
  error_code ec;
  socket.non_blocking(true, ec);
  if (!ec) socket.write_some(asio::buffer(text), ec);
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

// The order of the members is the order of their lives: connections outlast the lanes that hold their coroutines, and the jobs,
// whose last handler may still be on its way into a lane, end first.
struct Server::State {
  State(const MeshStore& meshes, const ViewerFiles& viewer, ServerOptions given)
      : store(meshes), options(std::move(given)), router(meshes, viewer), lanes(std::max<std::size_t>(options.threads, 1)) {}

  asio::awaitable<void> acceptConnections();
  void handOver(tcp::socket socket, asio::io_context& context);
  void end();
  void stopLanes() {
    for (Lane& lane : lanes) lane.context.stop();
  }
  void watchSignals();
  [[nodiscard]] asio::io_context& mainContext() { return lanes.front().context; }

  const MeshStore& store;
  ServerOptions options;
  Router router;
  Connections connections{options.maxConnections};
  std::vector<Lane> lanes;
  tcp::acceptor acceptor{mainContext()};
  asio::steady_timer grace{mainContext()};
  asio::steady_timer rest{mainContext()};
  asio::signal_set signals{mainContext()};
  bool ending = false;  // main lane's own
  LevelJobs jobs{limits::kLevelThreads, limits::kMaxLevelJobs, options.makeLevel};
  Services services{store, router, jobs};
};

asio::awaitable<void> Server::State::acceptConnections() {
  for (std::size_t next = 0; !ending; next = (next + 1) % lanes.size()) {
    asio::io_context& context = lanes[next].context;
    tcp::socket socket(context);
    error_code ec;
    co_await acceptor.async_accept(socket, asio::redirect_error(asio::use_awaitable, ec));
    if (!ec) {
      handOver(std::move(socket), context);
    } else if (!ending && ec != asio::error::operation_aborted) {
      spdlog::warn("a connection cannot be accepted: {}", ec.message());
      rest.expires_after(limits::kAcceptRest);
      co_await rest.async_wait(asio::redirect_error(asio::use_awaitable, ec));
    }
  }
}

void Server::State::handOver(tcp::socket socket, asio::io_context& context) {
  std::shared_ptr<Connection> connection = connections.enter(context.get_executor());
  if (!connection) return turnAway(std::move(socket));
  configure(socket);
  // Posted first: co_spawn would begin the coroutine on this thread.
  asio::post(context, [this, socket = std::move(socket), connection = std::move(connection), &context]() mutable {
    asio::co_spawn(context, serveHttp(beast::tcp_stream(std::move(socket)), services, std::move(connection)), logEnd);
  });
}

void Server::State::end() {
  if (ending) return stopLanes();  // asked twice: at once
  ending = true;
  spdlog::info("ending; responses under way have {} s", std::chrono::duration_cast<std::chrono::seconds>(limits::kGraceTime).count());
  error_code ec;
  acceptor.close(ec);
  grace.expires_after(limits::kGraceTime);
  grace.async_wait([this](error_code cancelled) {
    if (cancelled) return;
    spdlog::warn("some connections did not end in time and were cut");
    stopLanes();
  });
  connections.endAll([this] { asio::post(mainContext(), [this] { stopLanes(); }); });
}

void Server::State::watchSignals() {
  for (const int signal : {SIGINT, SIGTERM}) signals.add(signal);
  auto wait = std::make_shared<std::function<void()>>();
  *wait = [this, weak = std::weak_ptr(wait)] {
    signals.async_wait([this, wait = weak.lock()](error_code ec, int) {
      if (ec) return;
      end();
      (*wait)();
    });
  };
  (*wait)();
}

Server::Server(const MeshStore& store, const ViewerFiles& viewer, ServerOptions options)
    : state_(std::make_unique<State>(store, viewer, std::move(options))) {}

/// Connections that outlived the grace time go with the lanes; the last of them must not call into what is half gone.
Server::~Server() { state_->connections.endAll({}); }

Status Server::listen() {
  const auto refused = [this](const error_code& ec) {
    return fail(ErrorCode::kIo, "cannot listen on " + state_->options.host + ":" + std::to_string(state_->options.port) + ": " +
                                    ec.message() + "; choose another --host or --port");
  };
  error_code ec;
  tcp::resolver resolver(state_->mainContext());
  const auto found = resolver.resolve(state_->options.host, std::to_string(state_->options.port), tcp::resolver::passive, ec);
  if (ec) return refused(ec);
  const tcp::endpoint endpoint = *found.begin();
  tcp::acceptor& acceptor = state_->acceptor;
  acceptor.open(endpoint.protocol(), ec);
  if (!ec) acceptor.set_option(tcp::acceptor::reuse_address(true), ec);
  if (!ec) acceptor.bind(endpoint, ec);
  if (!ec) acceptor.listen(tcp::acceptor::max_listen_connections, ec);
  if (ec) return refused(ec);
  return {};
}

std::uint16_t Server::port() const { return state_->acceptor.local_endpoint().port(); }

std::string Server::url() const {
  const tcp::endpoint at = state_->acceptor.local_endpoint();
  const std::string host = at.address().to_string();
  return "http://" + (at.address().is_v6() ? "[" + host + "]" : host) + ":" + std::to_string(at.port()) + "/";
}

void Server::run() {
  if (state_->options.endOnSignals) state_->watchSignals();
  asio::co_spawn(state_->mainContext(), state_->acceptConnections(), logEnd);
  std::vector<std::jthread> others;
  for (std::size_t i = 1; i < state_->lanes.size(); ++i) others.emplace_back([&lane = state_->lanes[i]] { lane.context.run(); });
  state_->mainContext().run();
}

void Server::stop() {
  asio::post(state_->mainContext(), [this] {
    if (!state_->ending) state_->end();
  });
}

}  // namespace qtet
