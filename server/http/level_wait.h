// Waiting for a level on a connection whose client may go meanwhile.
#pragma once

#include <utility>  // before any Asio header: 1.74 uses std::exchange without it

#include <boost/asio/awaitable.hpp>
#include <variant>

#include "server/store/level_jobs.h"
#include "server/wire/client_socket.h"

namespace qtet {

using LevelAnswer = std::variant<Result<LevelFile>, LevelRefusal>;

/// Has the level made. Runs on the socket's executor; nothing else may use the socket meanwhile.
boost::asio::awaitable<LevelAnswer> waitForLevel(ClientSocket& socket, LevelJobs& jobs,
                                                 LevelRequest request,
                                                 LevelJobs::Address from = nullptr);

}  // namespace qtet
