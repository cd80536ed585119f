// Who may read what, over HTTP: refusals, `POST /v1/tickets`, and the door of `/v1/stream`
// (PROTOCOL.md, "Tokens").
#pragma once

#include <expected>
#include <optional>

#include "server/http/http_message.h"
#include "server/wire/access.h"
#include "server/wire/request_target.h"

namespace qtet {

/// 401 or 403, also for a mesh that does not exist, so that nobody learns of names; nullopt:
/// allowed.
[[nodiscard]] std::optional<Reply> refusalOf(Tokens::Verdict verdict, Tokens::Scope scope);

/// 400 for a query with a parameter that is given twice: nobody can say which one counts.
[[nodiscard]] std::optional<Reply> repeatedRefusal(const RequestTarget& target);

/// `POST /v1/tickets`: 201 with {"ticket","seconds"}, 401, or 429.
[[nodiscard]] Reply ticketReply(const RequestView& request, Access& access);

/// The meshes that a WebSocket may read, by its `ticket` parameter, or by its Authorization if it
/// can send one. Else 401, or 400 for a parameter that is given twice. With `access` nullptr it may
/// read everything.
[[nodiscard]] std::expected<MayRead, Reply> admitStream(const RequestView& request, Access* access);

/// Keeps shared caches from giving the reply to others.
void keepPrivate(Reply& reply);

}  // namespace qtet
