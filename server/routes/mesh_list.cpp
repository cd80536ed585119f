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

/// Where the page begins, and how long it may be.
struct PageStart {
  Catalogue::Meshes::const_iterator at;
  std::size_t limit = 0;
};

/// The page in its plain form, with the path of the next.
KeptPage makePage(const CataloguePointer& catalogue, PageStart start, const MayRead& mayRead) {
  std::string text = R"({"meshes":[)", next, last;
  auto it = start.at;
  const auto skipHidden = [&] {
    while (it != catalogue->meshes.end() && mayRead && !mayRead(it->first)) ++it;
  };
  std::size_t count = 0;
  for (skipHidden(); it != catalogue->meshes.end() && count < start.limit;
       ++it, ++count, skipHidden()) {
    text += (count > 0 ? "," : "") + it->second->listEntry;
    last = it->first;
  }
  text += "]";
  if (it != catalogue->meshes.end()) {
    next = "/v1/meshes?limit=" + std::to_string(start.limit) + "&after=" + percentEncode(last);
    text += ",\"next\":" + dumpJson(Json(next));
  }
  if (!catalogue->unread.empty()) text += R"(,"complete":false)";
  text += "}";
  return {Bytes(text.begin(), text.end()), ContentCoding::kIdentity, std::move(next)};
}

/// The same in that coding, if it is large enough for one.
KeptPagePointer inCoding(KeptPage page, ContentCoding coding) {
  if (page.bytes.size() >= kMinCompressedBytes) {
    page.bytes = encoded(std::move(page.bytes), coding);
    page.coding = coding;
  }
  return std::make_shared<const KeptPage>(std::move(page));
}

/// The page, and its tag without quotes and coding.
struct TaggedPage {
  KeptPagePointer page;
  std::string tag;
};

/// The same for all: made once for each version of the catalogue.
TaggedPage openPage(const CataloguePointer& catalogue, PageStart start, ContentCoding coding,
                    KeptPages& kept) {
  const std::string first = start.at == catalogue->meshes.end() ? "" : start.at->first;
  const std::string tag =
      hexDigestOf(catalogue->etag + (catalogue->unread.empty() ? " " : " incomplete ") +
                  std::to_string(start.limit) + ' ' + first);
  const std::string key = tag + std::string(codingName(coding));
  KeptPagePointer page = kept.find(key);
  if (!page) kept.keep(key, page = inCoding(makePage(catalogue, start, {}), coding));
  return {std::move(page), tag};
}

/// Known by its bytes alone, since who may read what changes unseen; compressed once.
TaggedPage restrictedPage(KeptPage plain, ContentCoding coding, KeptPages& kept) {
  const std::string tag = hexDigestOf(ByteView(plain.bytes));
  const std::string key = tag + std::string(codingName(coding));
  KeptPagePointer page = kept.find(key);
  if (!page) kept.keep(key, page = inCoding(std::move(plain), coding));
  return {std::move(page), tag};
}

}  // namespace

Reply meshListReply(const RequestView& request, const RequestTarget& target,
                    const CataloguePointer& catalogue, KeptPages& kept, const MayRead& mayRead) {
  const std::optional<std::size_t> limit = pageSize(target);
  if (!limit)
    return problem(400, "bad-request",
                   "limit is a whole number from 1 to " + std::to_string(limits::kMaxListPage));
  const std::string after = target.parameter("after").value_or("");
  const PageStart start = {
      after.empty() ? catalogue->meshes.begin() : catalogue->meshes.upper_bound(after), *limit};
  const ContentCoding coding = chooseCoding(request.acceptEncoding.value_or(""), true, true);
  const auto [page, tag] = mayRead
                               ? restrictedPage(makePage(catalogue, start, mayRead), coding, kept)
                               : openPage(catalogue, start, coding, kept);
  Resource resource{{'"' + tag + '"', catalogue->changed}, "application/json", kRevalidate, {}};
  if (!page->next.empty())
    resource.headers.emplace_back("Link", "<" + page->next + ">; rel=\"next\"");
  becomeVariant(resource, page->coding);
  return bytesReply(request, resource, page->bytes, page);
}

}  // namespace qtet
