#include "server/routes/access_routes.h"

#include <algorithm>

#include "proto/json_reader.h"
#include "server/wire/token_limits.h"

namespace qtet {
namespace {

Reply unauthorized(std::string_view detail) {
  Reply out = problem(401, "unauthorized", detail);
  out.headers.add("WWW-Authenticate", "Bearer realm=\"qtet\"");
  return out;
}

}  // namespace

std::optional<Reply> refusalOf(Tokens::Verdict verdict, Tokens::Scope scope) {
  const bool reading = scope == Tokens::Scope::kRead;
  switch (verdict) {
    case Tokens::Verdict::kAllowed: return std::nullopt;
    case Tokens::Verdict::kForbidden:
      return problem(403, "forbidden",
                     reading ? "this token is for other meshes"
                             : "this token is for other meshes, or for reading alone");
    case Tokens::Verdict::kUnknown: break;
  }
  return unauthorized(
      reading ? "send a token that may read this mesh, as Authorization: Bearer TOKEN"
              : "send a token that may write this mesh, as Authorization: Bearer TOKEN");
}

std::optional<Reply> repeatedRefusal(const RequestTarget& target) {
  const std::optional<std::string> name = target.repeatedParameter();
  if (!name) return std::nullopt;
  return badRequestReply("the parameter '" + *name + "' is given twice; give it once");
}

Reply ticketReply(const RequestView& request, Access& access) {
  const std::optional<SecretDigest> bearer = bearerDigest(request.authorization);
  if (!access.tokens()->knows(bearer))
    return unauthorized("send a token, as Authorization: Bearer TOKEN");
  const std::optional<std::string> ticket = access.giveTicket(*bearer);
  if (!ticket) {
    Reply busy = problem(429, "too-many-requests",
                         "there are as many unused tickets of this token as there may be");
    busy.refusal = Refusal::kPlaces;
    busy.headers.add("Retry-After", std::to_string(limits::kTicketTime.count()));
    return busy;
  }
  return momentaryReply(201, "application/json",
                        dumpJson({{"ticket", *ticket}, {"seconds", limits::kTicketTime.count()}}));
}

std::expected<MayRead, Reply> admitStream(const RequestView& request, Access* access) {
  const std::optional<RequestTarget> target = parseTarget(request.target);
  if (target)
    if (std::optional<Reply> refusal = repeatedRefusal(*target))
      return std::unexpected(std::move(*refusal));
  if (access == nullptr) return MayRead();
  std::optional<SecretDigest> bearer = bearerDigest(request.authorization);
  const std::optional<std::string> ticket = target ? target->parameter("ticket") : std::nullopt;
  if (ticket) bearer = access->takeTicket(*ticket);
  // Who says nothing may still open what is anyone's.
  const bool named = ticket || bearer;
  if (named && access->tokens()->guardReading() && !access->tokens()->knows(bearer))
    return std::unexpected(
        unauthorized("the ticket is used, too old, or none, or nobody has that token; POST "
                     "/v1/tickets gives another"));
  return access->readerOf(bearer);
}

void keepPrivate(Reply& reply) {
  constexpr std::string_view kPublic = "public";
  const std::string cache(reply.header("Cache-Control")), vary(reply.header("Vary"));
  if (cache.starts_with(kPublic))
    reply.headers.set("Cache-Control", "private" + cache.substr(kPublic.size()));
  reply.headers.set("Vary", vary.empty() ? "Authorization" : vary + ", Authorization");
}

}  // namespace qtet
