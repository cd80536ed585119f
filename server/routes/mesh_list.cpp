#include "server/routes/mesh_list.h"

#include <charconv>

#include "proto/json_reader.h"
#include "server/http/http_resource.h"
#include "server/store/store_limits.h"
#include "server/wire/digest.h"

namespace qtet {
namespace {

std::optional<std::size_t> pageSize(const RequestTarget& target) {
  const std::optional<std::string> text = target.parameter("limit");
  if (!text) return limits::kMaxListPage;
  std::size_t out = 0;
  const auto [end, ec] = std::from_chars(text->data(), text->data() + text->size(), out);
  const bool whole = ec == std::errc() && end == text->data() + text->size();
  return whole && out >= 1 && out <= limits::kMaxListPage ? std::optional(out) : std::nullopt;
}

}  // namespace

Reply meshListReply(const RequestView& request, const RequestTarget& target,
                    const CataloguePointer& catalogue, const MayRead& mayRead) {
  const std::optional<std::size_t> limit = pageSize(target);
  if (!limit)
    return problem(400, "bad-request",
                   "limit is a whole number from 1 to " + std::to_string(limits::kMaxListPage));
  const std::string after = target.parameter("after").value_or("");
  std::vector<std::pair<std::string, std::string>> headers;
  std::string text = R"({"meshes":[)";
  auto it = after.empty() ? catalogue->meshes.begin() : catalogue->meshes.upper_bound(after);
  std::size_t count = 0;
  const auto skipHidden = [&] {
    while (it != catalogue->meshes.end() && mayRead && !mayRead(it->first)) ++it;
  };
  std::string last;
  for (skipHidden(); it != catalogue->meshes.end() && count < *limit; ++it, ++count, skipHidden()) {
    text += (count > 0 ? "," : "") + it->second->listEntry;
    last = it->first;
  }
  text += "]";
  if (it != catalogue->meshes.end()) {
    const std::string next =
        "/v1/meshes?limit=" + std::to_string(*limit) + "&after=" + percentEncode(last);
    text += ",\"next\":" + dumpJson(Json(next));
    headers.emplace_back("Link", "<" + next + ">; rel=\"next\"");
  }
  const auto page = std::make_shared<const std::string>(text + "}");
  const std::string seed =
      mayRead ? *page : catalogue->etag + ' ' + std::to_string(*limit) + ' ' + after;
  Resource resource{{'"' + hexDigestOf(seed) + '"', catalogue->changed},
                    "application/json",
                    kRevalidate,
                    std::move(headers)};
  const ContentCoding coding = page->size() < kMinCompressedBytes
                                   ? ContentCoding::kIdentity
                                   : chooseCoding(request.acceptEncoding.value_or(""), true, true);
  becomeVariant(resource, coding);
  if (coding == ContentCoding::kIdentity) return bytesReply(request, resource, viewOf(*page), page);
  const auto small =
      std::make_shared<const Bytes>(encoded(Bytes(page->begin(), page->end()), coding));
  return bytesReply(request, resource, *small, small);
}

}  // namespace qtet
