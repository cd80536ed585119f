#include "server/http_router.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>

#include "proto/checksum.h"
#include "server/content_coding.h"
#include "server/descriptions.h"
#include "server/http_conditions.h"

namespace qtet {
namespace {

constexpr std::string_view kAllow = "GET, HEAD, OPTIONS";
constexpr std::string_view kRevalidate = "no-cache";
constexpr std::string_view kForEver = "public, max-age=31536000, immutable";
/// The page may compile WebAssembly, start workers from blobs and read logs from other hosts; nothing else comes from elsewhere.
constexpr std::string_view kPagePolicy =
    "default-src 'self'; script-src 'self' 'wasm-unsafe-eval'; worker-src 'self' blob:; style-src 'self' 'unsafe-inline'; "
    "img-src 'self' data: blob:; connect-src 'self' http: https: ws: wss: blob: data:; object-src 'none'; base-uri 'none'; form-action "
    "'none'";

/// Something that can be sent: bytes, what they are, and how long they may be kept.
struct Resource {
  Validators validators;
  std::string type;
  std::string_view cacheControl = kRevalidate;
  std::vector<std::pair<std::string, std::string>> headers;
};

Reply begin(unsigned status, const Resource& resource) {
  Reply out;
  out.status = status;
  out.headers = {{"ETag", resource.validators.etag},
                 {"Last-Modified", httpDate(resource.validators.modified)},
                 {"Cache-Control", std::string(resource.cacheControl)}};
  if (status != 304) out.headers.emplace_back("Content-Type", resource.type);
  out.headers.insert(out.headers.end(), resource.headers.begin(), resource.headers.end());
  addCommonHeaders(out);
  return out;
}

/// 304 and 412; nullopt when the body is to be sent.
std::optional<Reply> conditional(const RequestView& request, const Resource& resource) {
  switch (evaluateConditions(request, resource.validators)) {
    case Verdict::kSend: return std::nullopt;
    case Verdict::kNotModified: return begin(304, resource);
    case Verdict::kPreconditionFailed: break;
  }
  return problem(412, "precondition-failed", "the resource is another one by now: its ETag is " + resource.validators.etag);
}

Reply sendBytes(const RequestView& request, const Resource& resource, ByteView bytes) {
  if (std::optional<Reply> early = conditional(request, resource)) return std::move(*early);
  const ByteRange range = selectRange(request, resource.validators, bytes.size());
  const std::string size = std::to_string(bytes.size());
  if (range.kind == ByteRange::Kind::kUnsatisfiable) {
    Reply out = problem(416, "range-not-satisfiable", "the range starts behind the end; there are " + size + " bytes");
    out.headers.emplace_back("Content-Range", "bytes */" + size);
    return out;
  }
  const bool part = range.kind == ByteRange::Kind::kPart;
  Reply out = begin(part ? 206 : 200, resource);
  out.headers.emplace_back("Accept-Ranges", "bytes");
  if (part)
    out.headers.emplace_back("Content-Range",
                             "bytes " + std::to_string(range.first) + "-" + std::to_string(range.first + range.size - 1) + "/" + size);
  out.body = part ? bytes.subspan(range.first, range.size) : bytes;
  return out;
}

ByteView viewOf(const std::string& text) { return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}; }

/// "12" of "12.vtu"; no sign, no leading zero.
std::optional<std::uint32_t> parseLevel(std::string_view text) {
  std::uint32_t out = 0;
  const auto [end, ec] = std::from_chars(text.data(), text.data() + text.size(), out);
  if (ec != std::errc() || end != text.data() + text.size() || (text.size() > 1 && text[0] == '0')) return std::nullopt;
  return out;
}

Reply optionsReply() {
  Reply out;
  out.status = 204;
  out.headers = {{"Allow", std::string(kAllow)},
                 {"Access-Control-Allow-Methods", std::string(kAllow)},
                 {"Access-Control-Allow-Headers", "Range, If-Range, If-Match, If-None-Match, If-Modified-Since, If-Unmodified-Since"},
                 {"Access-Control-Max-Age", "7200"}};
  addCommonHeaders(out);
  return out;
}

Reply notFound(std::string_view detail) { return problem(404, "not-found", detail); }

/// Methods of RFC 9110 that no path here takes; anything else was never heard of.
bool knownMethod(std::string_view method) {
  constexpr std::array<std::string_view, 6> kKnown = {"POST", "PUT", "DELETE", "PATCH", "TRACE", "CONNECT"};
  return std::ranges::find(kKnown, method) != kKnown.end();
}

Reply methodRefused(std::string_view method) {
  Reply out = knownMethod(method) ? problem(405, "method-not-allowed", "this server can only be read: " + std::string(kAllow))
                                  : problem(501, "not-implemented", "this server can only be read: " + std::string(kAllow));
  out.headers.emplace_back("Allow", kAllow);
  return out;
}

/// Names joined by "/", or nullopt where one of them cannot be a file of the viewer.
std::optional<std::string> relativePath(const std::vector<std::string>& segments) {
  std::string out;
  for (const std::string& segment : segments) {
    const bool last = &segment == &segments.back();
    if (segment.starts_with('.') || segment.find('/') != std::string::npos || (segment.empty() && !last)) return std::nullopt;
    out += segment + (last ? "" : "/");
  }
  return out;
}

}  // namespace

Router::Document Router::makeDocument(std::string text) {
  std::string etag = '"' + sha256Hex(viewOf(text)) + '"';
  return {std::move(text), std::move(etag)};
}

Router::Router(const MeshStore& store, const ViewerFiles& viewer)
    : store_(store),
      viewer_(viewer),
      started_(std::chrono::system_clock::to_time_t(std::chrono::system_clock::now())),
      list_(makeDocument(describeMeshes(store))) {
  for (const auto& [id, mesh] : store.meshes()) meshes_.emplace(id, makeDocument(describeMesh(mesh)));
}

Reply Router::route(const RequestView& request) const {
  if (request.method == "OPTIONS") return optionsReply();
  if (request.method != "GET" && request.method != "HEAD") return methodRefused(request.method);
  const std::optional<RequestTarget> target = parseTarget(request.target);
  Reply out = target ? find(request, *target)
                     : problem(400, "bad-request", "the request's target is no path: a percent code or a byte in it is wrong");
  out.sendBody = request.method != "HEAD";
  return out;
}

Reply Router::find(const RequestView& request, const RequestTarget& target) const {
  const auto& path = target.segments;
  if (path[0] != "v1") return viewerReply(request, target);
  if (path.size() == 2 && path[1] == "stream") {
    Reply out = problem(426, "upgrade-required", "this is a WebSocket, subprotocol qtet.v1");
    out.headers.emplace_back("Upgrade", "websocket");
    return out;
  }
  if (path.size() < 2 || path[1] != "meshes") return notFound("there is nothing of that path; the list of meshes is at /v1/meshes");
  return path.size() == 2 ? documentReply(request, list_) : meshReply(request, target);
}

Reply Router::meshReply(const RequestView& request, const RequestTarget& target) const {
  const auto& path = target.segments;
  const ServedMesh* mesh = store_.find(path[2]);
  if (mesh == nullptr) return notFound("there is no mesh of that name; the list is at /v1/meshes");
  if (path.size() == 3) return documentReply(request, meshes_.find(path[2])->second);
  if (path.size() == 4 && path[3] == "log") return logReply(request, target, *mesh);
  if (path.size() == 5 && path[3] == "levels") return levelReply(request, *mesh, path[4]);
  return notFound("a mesh has log, levels/{k}.vtu and levels/{k}.drc");
}

Reply Router::documentReply(const RequestView& request, const Document& document) const {
  return sendBytes(request, {{document.etag, started_}, "application/json", kRevalidate, {}}, viewOf(document.text));
}

Reply Router::logReply(const RequestView& request, const RequestTarget& target, const ServedMesh& mesh) {
  const std::optional<std::string> digest = target.parameter("digest");
  if (digest && *digest != mesh.log.digest())
    return problem(404, "log-changed", "the mesh of that name has the digest " + mesh.log.digest() + " by now");
  return sendBytes(request,
                   {{'"' + mesh.log.digest() + '"', mesh.modified}, "application/octet-stream", digest ? kForEver : kRevalidate, {}},
                   mesh.log.bytes());
}

Reply Router::levelReply(const RequestView& request, const ServedMesh& mesh, std::string_view name) {
  const bool vtu = name.ends_with(".vtu");
  if (!vtu && !name.ends_with(".drc")) return notFound("a level is to be had as {k}.vtu and {k}.drc");
  const std::optional<std::uint32_t> level = parseLevel(name.substr(0, name.size() - 4));
  if (!level || *level >= mesh.manifest.levels.size())
    return notFound("there is no such level; this mesh has the levels 0 to " + std::to_string(mesh.manifest.levels.size() - 1));

  // The same log gives the same level, with one version of this program.
  const std::string etag = '"' + mesh.log.digest() + "-" + std::string(name) + "-" QTET_VERSION "\"";
  const Resource resource{{etag, mesh.modified},
                          "application/octet-stream",
                          kRevalidate,
                          {{"Content-Disposition", "attachment; filename=\"level-" + std::string(name) + "\""}, {"Accept-Ranges", "none"}}};
  if (std::optional<Reply> early = conditional(request, resource)) return std::move(*early);
  Reply out = begin(200, resource);
  out.body = LevelRequest{&mesh, *level, vtu ? LevelRequest::Form::kVtu : LevelRequest::Form::kDrc};
  return out;
}

Reply Router::viewerReply(const RequestView& request, const RequestTarget& target) const {
  if (viewer_.empty()) return notFound("this server was started without the viewer's files (--viewer DIR); its meshes are at /v1/meshes");
  const std::optional<std::string> path = relativePath(target.segments);
  const ViewerFile* file = path ? viewer_.find(*path) : nullptr;
  if (file == nullptr) return notFound("the viewer has no file of that name; its page is at /");
  Resource resource{{file->etag, file->modified}, file->type, file->immutable ? kForEver : kRevalidate, {}};
  if (file->type.starts_with("text/html")) resource.headers.emplace_back("Content-Security-Policy", kPagePolicy);
  if (file->gzip.empty()) return sendBytes(request, resource, file->bytes);
  resource.headers.emplace_back("Vary", "Accept-Encoding");
  if (!request.acceptEncoding || !acceptsGzip(*request.acceptEncoding)) return sendBytes(request, resource, file->bytes);
  resource.validators.etag.insert(resource.validators.etag.size() - 1, "-gzip");  // other bytes, another strong tag
  resource.headers.emplace_back("Content-Encoding", "gzip");
  return sendBytes(request, resource, file->gzip);
}

}  // namespace qtet
