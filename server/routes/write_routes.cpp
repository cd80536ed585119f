#include "server/routes/write_routes.h"

#include <cassert>

#include "codec/log/log_delta.h"
#include "proto/json_reader.h"
#include "proto/log_digest.h"
#include "server/routes/access_routes.h"
#include "server/routes/level_answer.h"

namespace qtet {
namespace {

/// "bytes 100-199/200" into first and total, and, of an empty body, "bytes */200": all of them are
/// there. False where it is nothing of that kind or speaks of another number of bytes.
bool readContentRange(std::string_view text, UploadRequest& out) {
  constexpr std::string_view kUnit = "bytes ";
  if (!text.starts_with(kUnit)) return false;
  text.remove_prefix(kUnit.size());
  if (const auto all = text.starts_with("*/") && out.bodyBytes == 0
                           ? parseNumber<std::uint64_t>(text.substr(2))
                           : std::nullopt) {
    out.first = out.totalBytes = *all;
    return *all > 0;  // from 0 on the upload would begin anew
  }
  const std::size_t dash = text.find('-'), slash = text.find('/');
  if (dash == std::string_view::npos || slash == std::string_view::npos || dash > slash)
    return false;
  const auto first = parseNumber<std::uint64_t>(text.substr(0, dash)),
             last = parseNumber<std::uint64_t>(text.substr(dash + 1, slash - dash - 1)),
             total = parseNumber<std::uint64_t>(text.substr(slash + 1));
  if (!first || !last || !total || *last < *first || *last >= *total) return false;
  if (!out.from && *last - *first + 1 != out.bodyBytes) return false;
  if (out.from && *last + 1 != *total) return false;
  out.first = *first;
  out.totalBytes = *total;
  return true;
}

/// 401 and 403; nullopt: the request may go on.
std::optional<Reply> authorise(const RequestView& request, const std::string& mesh,
                               const Access& access) {
  constexpr auto kScope = Tokens::Scope::kWrite;
  return refusalOf(access.tokens()->may(kScope, bearerDigest(request.authorization), mesh), kScope);
}

Answer routePut(const RequestView& request, const RequestTarget& target, UploadRequest out) {
  if (!request.contentLength)
    return problem(411, "length-required", "a log is sent with its Content-Length");
  if (request.contentEncoding)
    return problem(415, "unsupported-media-type",
                   "a log is sent as it is, without a Content-Encoding");
  // too large in any case
  out.bodyBytes = parseNumber<std::uint64_t>(*request.contentLength).value_or(~std::uint64_t{0});
  out.totalBytes = out.bodyBytes;
  out.digest = target.parameter("digest");
  if (out.digest && !isLogDigest(*out.digest))
    return badRequestReply("digest is the log's SHA-256, 64 hexadecimal digits in lower case");
  out.from = target.parameter("from");
  if (out.from && !isLogDigest(*out.from))
    return badRequestReply("from is the old log's SHA-256, 64 hexadecimal digits in lower case");
  if ((request.contentRange || out.from) && !out.digest)
    return badRequestReply("a part of a log is sent with ?digest= of the whole");
  if (out.from && !request.contentRange)
    return badRequestReply(
        "a delta comes with Content-Range: bytes FIRST-LAST/SIZE of the new log");
  if (request.contentRange && !readContentRange(*request.contentRange, out))
    return badRequestReply(
        "Content-Range is bytes FIRST-LAST/SIZE, and the body has as many bytes; or bytes */SIZE, "
        "and it has none");
  if (out.from && out.bodyBytes / kMaxDeltaBytesAByte > out.totalBytes - out.first)
    return problem(413, "content-too-large",
                   "a delta has at most " + std::to_string(kMaxDeltaBytesAByte) +
                       " bytes for each byte that it gives");
  return Answer(std::move(out));
}

}  // namespace

bool isMeshPath(const RequestTarget& target) {
  const auto& path = target.segments;
  return path.size() == 3 && path[0] == "v1" && path[1] == "meshes";
}

Answer routeWriting(const RequestView& request, const RequestTarget& target, const Access& access) {
  assert(isMeshPath(target));
  const std::string& id = target.segments[2];
  if (std::optional<Reply> refusal = authorise(request, id, access)) return std::move(*refusal);
  if (!pathOfMesh("", id))
    return problem(404, "not-found",
                   "this cannot be the name of a mesh: a file name, not hidden, in UTF-8, without "
                   "control characters");
  UploadRequest out{.id = id};
  if (const auto bearer = bearerDigest(request.authorization))
    out.token.assign(bearer->begin(), bearer->end());
  if (request.ifMatch) out.ifMatch = *request.ifMatch;
  if (request.ifNoneMatch) out.ifNoneMatch = *request.ifNoneMatch;
  if (request.method == "PUT") return routePut(request, target, std::move(out));
  out.kind = UploadRequest::Kind::kDelete;
  return Answer(std::move(out));
}

Reply partialReply(const RequestView& request, const RequestTarget& target,
                   const Writing& writing) {
  assert(target.segments.size() == 4);
  if (std::optional<Reply> refusal = authorise(request, target.segments[2], writing.access))
    return std::move(*refusal);
  const std::optional<std::string> digest = target.parameter("digest");
  if (!digest || !isLogDigest(*digest))
    return badRequestReply("digest is the log's SHA-256, 64 hexadecimal digits in lower case");
  const std::string& id = target.segments[2];
  if (!pathOfMesh("", id)) return problem(404, "not-found", "this cannot be the name of a mesh");
  const std::optional<std::uint64_t> bytes = writing.uploads.partialBytes(id, *digest);
  if (!bytes) return problem(404, "not-found", "nothing is there of an upload of that log");
  return momentaryReply(200, "application/json",
                        dumpJson({{"digest", *digest}, {"bytes", *bytes}}));
}

}  // namespace qtet
