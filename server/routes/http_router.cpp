#include "server/routes/http_router.h"

#include <algorithm>
#include <array>
#include <ctime>

#include "server/http/http_resource.h"
#include "server/routes/access_routes.h"
#include "server/routes/first_page.h"
#include "server/routes/log_routes.h"
#include "server/routes/mesh_list.h"
#include "server/routes/openapi.h"

namespace qtet {
namespace {

constexpr std::string_view kAllow = "GET, HEAD, OPTIONS";
constexpr std::string_view kAllowTickets = "POST, OPTIONS";
constexpr std::string_view kAllowWriting = "GET, HEAD, OPTIONS, PUT, DELETE";
/// The page may compile WebAssembly, start workers from blobs and read logs from other hosts;
/// nothing else comes from elsewhere.
constexpr std::string_view kPagePolicy =
    "default-src 'self'; script-src 'self' 'wasm-unsafe-eval'; worker-src 'self' blob:; style-src "
    "'self' 'unsafe-inline'; "
    "img-src 'self' data: blob:; connect-src 'self' http: https: ws: wss: blob: data:; object-src "
    "'none'; base-uri 'none'; form-action "
    "'none'";
/// A link from the page does not reveal to its target which mesh was looked at.
constexpr const char* kReferrerPolicy = "same-origin";

Reply optionsReply(std::string_view allow = kAllow) {
  Reply out;
  out.status = 204;
  out.headers = {{"Allow", allow},
                 {"Access-Control-Allow-Methods", allow},
                 {"Access-Control-Allow-Headers",
                  "Authorization, Content-Range, Content-Type, Range, If-Range, If-Match, "
                  "If-None-Match, If-Modified-Since, If-Unmodified-Since, "
                  "traceparent, X-Request-Id"},
                 {"Access-Control-Max-Age", "7200"}};
  addCommonHeaders(out.headers);
  return out;
}

/// Methods of RFC 9110; anything else was never heard of.
bool knownMethod(std::string_view method) {
  constexpr std::array<std::string_view, 8> kKnown = {"GET",    "HEAD",  "POST",  "PUT",
                                                      "DELETE", "PATCH", "TRACE", "CONNECT"};
  return std::ranges::find(kKnown, method) != kKnown.end();
}

Reply methodRefused(std::string_view method, std::string_view allow = kAllow) {
  const std::string detail = "what is to be had here takes " + std::string(allow);
  Reply out = knownMethod(method) ? problem(405, "method-not-allowed", detail)
                                  : problem(501, "not-implemented", detail);
  out.headers.add("Allow", allow);
  return out;
}

/// Names joined by "/", or nullopt where one of them cannot be a file of the viewer.
std::optional<std::string> relativePath(const std::vector<std::string>& segments) {
  std::string out;
  for (const std::string& segment : segments) {
    const bool last = &segment == &segments.back();
    if (segment.starts_with('.') || segment.find('/') != std::string::npos ||
        (segment.empty() && !last))
      return std::nullopt;
    out += segment + (last ? "" : "/");
  }
  return out;
}

/// `/v1/meshes/{id}/...` leads to what the name stands for now; everything there is to be had for
/// ever under the digest.
Reply toLog(const RequestTarget& target, const ServedMesh& mesh) {
  std::string location = "/v1/logs/" + mesh.log.digest();
  for (std::size_t i = 3; i < target.segments.size(); ++i)
    location += "/" + percentEncode(target.segments[i]);
  if (!target.query.empty()) location += "?" + target.query;
  Reply out;
  out.status = 307;
  out.headers = {{"Location", location}, {"Cache-Control", kRevalidate}};
  addCommonHeaders(out.headers);
  return out;
}

/// Refuses with 401 or 403, also for a mesh that does not exist, so that names do not leak. The
/// list (nullptr) is refused only to an unknown token.
std::optional<Reply> readingRefusal(const RequestView& request, const std::string* mesh,
                                    const Tokens& tokens) {
  if (!tokens.guardReading()) return std::nullopt;
  constexpr auto kScope = Tokens::Scope::kRead;
  const std::optional<SecretDigest> bearer = bearerDigest(request.authorization);
  if (mesh != nullptr) return refusalOf(tokens.may(kScope, bearer, *mesh), kScope);
  return bearer && !tokens.knows(bearer) ? refusalOf(Tokens::Verdict::kUnknown, kScope)
                                         : std::nullopt;
}

/// A name under which the log may be read; several may stand for the same bytes.
std::optional<std::string> readableName(const MayRead& mayRead, const ServedMesh& mesh,
                                        const Catalogue& catalogue) {
  if (mayRead(mesh.id)) return mesh.id;
  const std::string& digest = mesh.log.digest();
  for (auto at = catalogue.logs.lowerBound({digest, ""});
       at != catalogue.logs.end() && (*at)->digest == digest; ++at)
    if (const EntryPointer* served = catalogue.meshes.find((*at)->id);
        served != nullptr && *served == *at && mayRead((*at)->id))
      return (*at)->id;
  return std::nullopt;
}

/// Handles the part that is the same for every path: methods, and invalid targets.
template <class Find>
Answer answer(const RequestView& request, Find find) {
  const std::optional<RequestTarget> target = parseTarget(request.target);
  // RFC 9112, 3.2: OPTIONS may be asked of "*", and CONNECT names no path
  const bool noPath = request.target == "*" || request.method == "CONNECT";
  if (target || noPath) {
    if (request.method == "OPTIONS") return optionsReply();
    if (request.method != "GET" && request.method != "HEAD") return methodRefused(request.method);
  }
  Answer out =
      target ? Answer(find(*target))
             : problem(400, "bad-request",
                       "the request's target is no path: a percent code or a byte in it is wrong");
  out.reply.sendBody = request.method != "HEAD";
  return out;
}

}  // namespace

Router::Router(const MeshStore& store, const ViewerFiles& viewer, const AdminRoutes* admin,
               std::optional<Writing> writing, const std::string& frameAncestors)
    : store_(store),
      viewer_(viewer),
      admin_(admin),
      writing_(std::move(writing)),
      openApi_(openApiJson(), {{"", std::time(nullptr)}, "application/json", kRevalidate}),
      pagePolicy_(std::string(kPagePolicy) + "; frame-ancestors " + frameAncestors) {
  if (const ViewerFile* page = viewer.find(""))
    pageLinks_ = linksOf({reinterpret_cast<const char*>(page->bytes.data()), page->bytes.size()});
}

/// Routes that only a server with tokens answers: changes, and tickets.
std::optional<Answer> Router::routeWithTokens(const RequestView& request,
                                              const RequestTarget& target) const {
  const bool ofTickets =
      target.segments.size() == 2 && target.segments[0] == "v1" && target.segments[1] == "tickets";
  const bool reads = request.method == "GET" || request.method == "HEAD";
  if (!ofTickets && (!isMeshPath(target) || reads)) return std::nullopt;
  const std::string_view allow = ofTickets ? kAllowTickets : kAllowWriting;
  if (request.method == "OPTIONS") return optionsReply(allow);
  if (std::optional<Reply> refusal = repeatedRefusal(target)) return std::move(*refusal);
  if (ofTickets && request.method == "POST") return ticketReply(request, writing_->access);
  if (!ofTickets && (request.method == "PUT" || request.method == "DELETE"))
    return routeWriting(request, target, writing_->access);
  return methodRefused(request.method, allow);
}

Answer Router::route(const RequestView& request) const {
  if (writing_) {
    const std::optional<RequestTarget> target = parseTarget(request.target);
    if (std::optional<Answer> found = target ? routeWithTokens(request, *target) : std::nullopt)
      return std::move(*found);
  }
  return answer(request, [&](const RequestTarget& target) { return find(request, target); });
}

Reply routeAdmin(const AdminRoutes& admin, const RequestView& request) {
  const auto find = [&](const RequestTarget& target) {
    return admin.route(target).value_or(
        missingReply("this address has livez, readyz, metrics and version"));
  };
  return answer(request, find).reply;
}

Answer Router::find(const RequestView& request, const RequestTarget& target) const {
  const auto& path = target.segments;
  if (path[0] == "v1") return api(request, target);
  if (path.size() == 1 && path[0] == "openapi.json")
    return documentReply(request, openApi_, nullptr);
  if (admin_ != nullptr)
    if (std::optional<Reply> reply = admin_->route(target)) return std::move(*reply);
  return viewerReply(request, target);
}

Answer Router::api(const RequestView& request, const RequestTarget& target) const {
  if (std::optional<Reply> refusal = repeatedRefusal(target)) return std::move(*refusal);
  const auto& path = target.segments;
  if (path.size() == 2 && path[1] == "stream") {
    Reply out = problem(426, "upgrade-required", "this is a WebSocket, subprotocol qtet.v1");
    out.headers.add("Upgrade", "websocket");
    return out;
  }
  if (path.size() >= 2 && path[1] == "meshes") return meshes(request, target);
  if (path.size() < 4 || path[1] != "logs")
    return missingReply("there is nothing of that path; the list of meshes is at /v1/meshes");
  return logs(request, target);
}

/// A log does not exist for a client that may not read it: nobody learns from a digest alone
/// whether the server has the log.
Answer Router::logs(const RequestView& request, const RequestTarget& target) const {
  const MeshPointer mesh = store_.findLog(target.segments[2]);
  if (!mesh && !writing_ && store_.mayHaveLog(target.segments[2]))
    return busyReply("this log cannot be opened now, or the folder is still being read; try again");
  std::optional<std::string> name = mesh ? std::optional(mesh->id) : std::nullopt;
  bool open = true;
  if (mesh && writing_) {
    const CataloguePointer catalogue = store_.catalogue();
    name = readableName(writing_->access.readerOf(std::nullopt), *mesh, *catalogue);
    open = name.has_value();
    if (!open)
      name = readableName(writing_->access.readerOf(bearerDigest(request.authorization)), *mesh,
                          *catalogue);
  }
  if (!name)
    return problem(404, "log-changed",
                   "no mesh has that digest, or not any more, or it is for those who have a token; "
                   "the list is at /v1/meshes");
  Answer out = routeLog(request, target, {mesh, *name});
  if (!open) keepPrivate(out.reply);
  if (auto* text = std::get_if<TextRequest>(&out.work)) text->isPrivate = !open;
  return out;
}

Answer Router::meshes(const RequestView& request, const RequestTarget& target) const {
  const auto& path = target.segments;
  if (writing_ && path.size() == 4 && path[3] == "upload")
    return partialReply(request, target, *writing_);
  if (writing_)
    if (std::optional<Reply> refusal = readingRefusal(request, path.size() > 2 ? &path[2] : nullptr,
                                                      *writing_->access.tokens()))
      return std::move(*refusal);
  if (path.size() == 2)
    return meshListReply(
        request, target, store_.catalogue(), *lists_,
        writing_ ? writing_->access.readerOf(bearerDigest(request.authorization)) : MayRead());
  const MeshPointer mesh = path.back().empty() ? nullptr : store_.find(path[2]);
  if (!mesh && !path.back().empty() && store_.mayHave(path[2]))
    return busyReply("this log cannot be opened now, or the folder is still being read; try again");
  if (!mesh) return missingReply("there is no mesh of that name; the list is at /v1/meshes");
  if (path.size() > 3) return toLog(target, *mesh);
  return textAnswer(request, mesh, ServedMesh::Text::kDescription);
}

Reply Router::viewerReply(const RequestView& request, const RequestTarget& target) const {
  if (viewer_.empty())
    return missingReply(
        "this server was started without the viewer's files (--viewer DIR); its meshes are at "
        "/v1/meshes");
  const std::optional<std::string> path = relativePath(target.segments);
  const ViewerFile* file = path ? viewer_.find(*path) : nullptr;
  if (file == nullptr) return missingReply("the viewer has no file of that name; its page is at /");
  Resource resource{
      {file->etag, file->modified}, file->type, file->immutable ? kForEver : kRevalidate, {}};
  becomeEmbeddable(resource);
  if (file->type.starts_with("text/html")) {
    resource.headers.add("Content-Security-Policy", pagePolicy_);
    resource.headers.add("Referrer-Policy", kReferrerPolicy);
  }
  if (file == viewer_.find("")) {
    const CataloguePointer catalogue = store_.catalogue();
    const MayRead mayRead = writing_ ? writing_->access.readerOf(std::nullopt) : MayRead();
    if (const EntryPointer mesh = meshOfPage(target, *catalogue, mayRead))
      return pageReply(request, *file, *mesh, pageLinks_, std::move(resource), *pages_);
    if (!pageLinks_.empty()) resource.headers.add("Link", pageLinks_);
  }
  return variantReply(request, std::move(resource), viewer_.variantsOf(*file), nullptr);
}

}  // namespace qtet
