// The server's sessions, with all that they need, on one context.
#pragma once

#include <utility>  // before any Asio header: 1.74 uses std::exchange without it

#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>
#include <cstdint>
#include <string>

#include "server/routes/http_router.h"
#include "server/session/services.h"
#include "server/store/kept_points.h"
#include "server/store/level_jobs.h"
#include "server/wire/address_limits.h"
#include "server/wire/connections.h"
#include "tests/server/simulator/kernel.h"

namespace qtet::simulator {

/// Small bounds, so that few clients reach them.
struct HostLimits {
  std::size_t connections = 120, connectionsOfAddress = 12;
  unsigned requestsPerSecond = 50;  ///< of one address
  Timeouts timeouts{};
};

/// Levels are noise of their request, made between two turns. Must outlive its connections.
class Host {
 public:
  Host(Kernel& kernel, std::uint64_t seed, const MeshStore& store, const ViewerFiles& viewer,
       const HostLimits& limits);
  ~Host();
  Host(const Host&) = delete;
  Host& operator=(const Host&) = delete;

  /// A client has connected. False: there is no place for it, and the connection is closed.
  bool accept(const SocketPointer& socket);
  /// Asks all to end; `whenEmpty` as Connections has it.
  void end(std::function<void()> whenEmpty);
  [[nodiscard]] std::size_t open() const { return connections_.open(); }
  /// Bytes that are kept for later requests.
  [[nodiscard]] std::uint64_t keptBytes() const { return router_.pageBytes() + points_.bytes(); }
  [[nodiscard]] boost::asio::io_context& context() { return context_; }
  /// Says what a session threw; "": nothing.
  std::string fault;

 private:
  [[nodiscard]] Workers later();
  /// Makes a level now and then.
  void work();
  Result<LevelFile> make(const LevelRequest& request, const std::stop_token& stop);

  Kernel& kernel_;
  Random random_;
  Router router_;
  Connections connections_;
  AddressLimits addresses_;
  Metrics metrics_;
  KeptPoints points_;
  // connections go with the context that holds their coroutines, and their jobs go before
  boost::asio::io_context context_{1};
  /// With it the context has its reactor, and sleeps in the kernel.
  boost::asio::steady_timer timer_{context_};
  LevelJobs jobs_, pointJobs_;
  Services services_;
};

}  // namespace qtet::simulator
