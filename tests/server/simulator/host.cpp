#include "tests/server/simulator/host.h"

#include <boost/asio/co_spawn.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <exception>

#include "server/session/http_session.h"
#include "server/store/store_limits.h"

namespace qtet::simulator {
namespace {

namespace asio = boost::asio;
constexpr auto kServer = MemoryOf::Whose::kServer;
/// Bytes of a level that is served.
constexpr std::size_t kMaxLevel = 300'000;
/// Memory that a level may take: none is that large.
constexpr std::uint64_t kLevelMemory = 1u << 30;

}  // namespace

Host::Host(Kernel& kernel, std::uint64_t seed, const MeshStore& store, const ViewerFiles& viewer,
           const HostLimits& limits)
    : kernel_(kernel),
      random_(seed),
      router_(store, viewer),
      connections_(limits.connections),
      addresses_({.connections = limits.connectionsOfAddress,
                  .requestsPerSecond = limits.requestsPerSecond}),
      jobs_({.threads = 0,
             .most = limits::kMaxLevelJobs,
             .maker = [this](const auto& level, const auto& stop) { return make(level, stop); },
             .maxOfAddress = limits::kMaxLevelJobsPerAddress}),
      pointJobs_({.threads = 0, .most = 1}),
      services_{.store = store,
                .route = [this](const RequestView& request) { return router_.route(request); },
                .jobs = jobs_,
                .pointJobs = pointJobs_,
                .maxLevelBytes = kLevelMemory,
                .metrics = metrics_,
                .timeouts = limits.timeouts,
                .writers = later(),
                .checkers = later(),
                .describers = later(),
                .addresses = &addresses_} {
  work();
}

/// Connections that are left go with the context; the last of them calls nobody.
Host::~Host() { connections_.endAll({}); }

Workers Host::later() {
  return [this](std::move_only_function<void()> work) {
    const MemoryOf own(kOwn);
    auto shared = std::make_shared<std::move_only_function<void()>>(std::move(work));
    kernel_.after(random_.between(100us, 20ms), [this, shared] {
      const MemoryOf server(kServer);
      std::exchange(*shared, {})();
      kernel_.wake();
    });
  };
}

void Host::work() {
  kernel_.after(random_.between(5ms, 50ms), [this] {
    {
      const MemoryOf server(kServer);
      if (jobs_.workOnce()) kernel_.wake();
    }
    work();
  });
}

Result<LevelFile> Host::make(const LevelRequest& request, const std::stop_token& stop) {
  kernel_.pass(random_.between(10us, 200us));
  if (stop.stop_requested() || random_.chance(30))
    return fail(ErrorCode::kIo, "the simulated maker has failed");
  const std::string key = request.key();
  Random noise(std::hash<std::string>()(key));
  return inMemory(Bytes(noise.between(1, kMaxLevel), static_cast<std::uint8_t>(key.back())));
}

bool Host::accept(const SocketPointer& socket) {
  const MemoryOf server(kServer);
  std::unique_ptr<AddressLimits::Client> client =
      addresses_.enter(asio::ip::address_v4(socket->address));
  std::shared_ptr<Connection> connection =
      client ? connections_.enter(context_.get_executor()) : nullptr;
  if (!connection) {
    kernel_.close(socket->descriptor);
    return false;
  }
  asio::ip::tcp::socket accepted(context_, asio::ip::tcp::v4(), socket->descriptor);
  asio::post(context_, [this, accepted = std::move(accepted), client = std::move(client),
                        connection = std::move(connection)]() mutable {
    asio::co_spawn(context_,
                   serveHttp(std::move(accepted), nullptr, services_, std::move(connection),
                             std::move(client), std::nullopt),
                   [this](const std::exception_ptr& thrown) {
                     if (thrown) fault = "a connection ended by an exception";
                   });
  });
  kernel_.wake();
  return true;
}

void Host::end(std::function<void()> whenEmpty) {
  const MemoryOf server(kServer);
  connections_.endAll(std::move(whenEmpty));
  kernel_.wake();
}

}  // namespace qtet::simulator
