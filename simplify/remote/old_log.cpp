#include "simplify/remote/old_log.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "proto/log_digest.h"

namespace qtet {
namespace {

/// Bytes of one request; an answer is at most 4 MiB.
constexpr std::uint64_t kRangeBytes = 1u << 20;
/// Bytes of a front, and of the later instants. A hundred thousand instants take as many. No delta
/// is worth more, whatever the server says.
constexpr std::uint64_t kMaxIndexBytes = 32u << 20;

Result<std::string> bodyOf(const HttpUrl& server, const HttpRequest& request, unsigned status) {
  Result<HttpAnswer> answer = exchange(server, request);
  if (!answer) return std::unexpected(answer.error());
  if (answer->status == 404) return fail(ErrorCode::kNotFound, request.target + " is not there");
  if (answer->status != status)
    return fail(ErrorCode::kIo,
                request.target + ": the server answers " + std::to_string(answer->status));
  return std::move(answer->body);
}

}  // namespace

Result<OldLog> fetchOldLog(const HttpUrl& server, const HttpRequest& request) {
  const Result<std::string> description = bodyOf(server, request, 200);
  if (!description) return std::unexpected(description.error());
  using Json = nlohmann::json;
  const auto json = Json::parse(*description, nullptr, false);
  if (!json.is_object() || !json.value("digest", Json()).is_string() ||
      !json.value("bytes", Json()).is_number_unsigned())
    return fail(ErrorCode::kIo, request.target + ": this is no mesh's description");
  OldLog out{.digest = json["digest"].get<std::string>(), .index = {}};
  if (!isLogDigest(out.digest))
    return fail(ErrorCode::kIo, request.target + ": the digest is none");
  const auto fileBytes = json["bytes"].get<std::uint64_t>();
  const auto fetch = [&](Bytes& into, std::uint64_t first, std::uint64_t end) -> Status {
    if (first > end || end > fileBytes || end - first > kMaxIndexBytes)
      return fail(ErrorCode::kLimitExceeded, "the log's front or its later instants are too long");
    for (; first < end; first += std::min(kRangeBytes, end - first)) {
      const std::uint64_t last = std::min(end, first + kRangeBytes) - 1;
      HttpRequest part = request;
      part.target = "/v1/logs/" + out.digest + "/log";
      part.headers.push_back("Range: bytes=" + std::to_string(first) + "-" + std::to_string(last));
      const auto body = bodyOf(server, part, 206);
      if (!body) return std::unexpected(body.error());
      if (body->size() != last - first + 1)
        return fail(ErrorCode::kIo, "the server sends another range than was asked for");
      into.insert(into.end(), body->begin(), body->end());
    }
    return {};
  };

  Bytes head;
  if (Status s = fetch(head, 0, std::min<std::uint64_t>(fileBytes, LogIndex::kHeaderBytes)); !s)
    return std::unexpected(s.error());
  const Result<std::uint64_t> headBytes = LogIndex::headBytesOf(head);
  if (!headBytes) return std::unexpected(headBytes.error());
  if (Status s = fetch(head, head.size(), *headBytes); !s) return std::unexpected(s.error());
  Result<LogIndex> index = LogIndex::parseHead(head);
  if (!index) return std::unexpected(index.error());
  if (index->fileBytes != fileBytes)
    return fail(ErrorCode::kIo, request.target + ": the log has another length than is said");
  if (const std::uint64_t later = std::min<std::uint64_t>(index->unreadBytes(), fileBytes)) {
    Bytes part;
    if (Status s = fetch(part, fileBytes - later, fileBytes); !s) return std::unexpected(s.error());
    if (Status s = index->readLater(part); !s) return std::unexpected(s.error());
  }
  out.index = std::move(*index);
  return out;
}

}  // namespace qtet
