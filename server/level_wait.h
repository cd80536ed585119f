// Waiting for a level on a connection whose client may go meanwhile.
#pragma once

#include <utility>  // before any Asio header: 1.74 uses std::exchange without it

#include <boost/asio/awaitable.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <cstdint>
#include <variant>

#include "server/level_jobs.h"

namespace qtet {

enum class LevelRefusal : std::uint8_t {
  kBusy,  ///< there are as many jobs as there may be
  kGone,  ///< the client closed; the job ends if nobody else wants it. A client that only closes its sending half counts as gone.
};
using LevelAnswer = std::variant<Result<LevelFile>, LevelRefusal>;

/// Has the level made. Runs on the socket's executor; nothing else may use the socket meanwhile.
boost::asio::awaitable<LevelAnswer> waitForLevel(boost::asio::ip::tcp::socket& socket, LevelJobs& jobs, LevelRequest request);

}  // namespace qtet
