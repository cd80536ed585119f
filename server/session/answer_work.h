// The work that an Answer's body takes: a level that is made, or an upload that is taken.
#pragma once

#include <utility>  // before any Asio header: 1.74 uses std::exchange without it

#include <boost/asio/awaitable.hpp>
#include <optional>

#include "server/routes/answer.h"
#include "server/session/http_input.h"
#include "server/session/services.h"
#include "server/wire/peer.h"

namespace qtet {

/// The reply once the work is done; of status kClientGone, and not to be sent, if the client has
/// left meanwhile. nullopt: the connection was lost before anything was begun. Runs on the peer's
/// executor; nothing else may use its socket meanwhile.
boost::asio::awaitable<std::optional<Reply>> workOn(Answer answer, const RequestView& request,
                                                    Peer& peer, HttpInput& input,
                                                    const Services& services);

}  // namespace qtet
