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
  Catalogue::Meshes::Iterator at;
  std::size_t limit = 0;
};

/// A page in its plain form, with the path of the next; "": it is the last.
struct PlainPage {
  std::string text, next;
};

PlainPage makePage(const Catalogue& catalogue, PageStart start, const MayRead& mayRead) {
  PlainPage out{R"({"meshes":[)", ""};
  std::string last;
  auto it = start.at;
  const auto skipHidden = [&] {
    while (it != catalogue.meshes.end() && mayRead && !mayRead((*it)->id)) ++it;
  };
  std::size_t count = 0;
  for (skipHidden(); it != catalogue.meshes.end() && count < start.limit;
       ++it, ++count, skipHidden()) {
    out.text += (count > 0 ? "," : "") + (*it)->listEntry;
    last = (*it)->id;
  }
  out.text += "]";
  if (it != catalogue.meshes.end()) {
    out.next = "/v1/meshes?limit=" + std::to_string(start.limit) + "&after=" + percentEncode(last);
    out.text += ",\"next\":" + dumpJson(Json(out.next));
  }
  if (!catalogue.complete()) out.text += R"(,"complete":false)";
  out.text += "}";
  return out;
}

/// The page as it is sent: in that coding, if it is large enough for one.
KeptPagePointer finish(const PlainPage& page, const std::string& tag, std::time_t changed,
                       ContentCoding coding) {
  if (page.text.size() < kMinCompressedBytes) coding = ContentCoding::kIdentity;
  Resource resource{{'"' + tag + '"', changed}, "application/json", kRevalidate};
  if (!page.next.empty()) resource.headers.add("Link", "<" + page.next + ">; rel=\"next\"");
  Bytes bytes = encoded({page.text.begin(), page.text.end()}, coding);
  return std::make_shared<const KeptPage>(
      KeptPage{formOf(std::move(resource), std::move(bytes), coding)});
}

/// A key ends with the coding and with the date, which stands in the head but not in the tag.
std::string keyOf(std::string key, std::time_t changed, ContentCoding coding) {
  key += ' ';
  key += codingName(coding);
  key += std::to_string(changed);
  return key;
}

/// The same for all: made once for each version of the catalogue.
KeptPagePointer openPage(const Catalogue& catalogue, PageStart start, ContentCoding coding,
                         KeptPages& kept) {
  std::string version = catalogue.etag();
  version += catalogue.complete() ? " " : " incomplete ";
  version += std::to_string(start.limit);
  version += ' ';
  if (start.at != catalogue.meshes.end()) version += (*start.at)->id;
  const std::string key = keyOf(version, catalogue.changed, coding);
  KeptPagePointer out = kept.find(key);
  if (out) return out;
  out = finish(makePage(catalogue, start, {}), tagOf(version), catalogue.changed, coding);
  kept.keep(key, out);
  return out;
}

/// Known by its bytes alone, since who may read what changes unseen; compressed once.
KeptPagePointer restrictedPage(const Catalogue& catalogue, PageStart start, const MayRead& mayRead,
                               ContentCoding coding, KeptPages& kept) {
  const PlainPage plain = makePage(catalogue, start, mayRead);
  const std::string tag = tagOf(plain.text);
  const std::string key = keyOf(tag, catalogue.changed, coding);
  KeptPagePointer out = kept.find(key);
  if (!out) kept.keep(key, out = finish(plain, tag, catalogue.changed, coding));
  return out;
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
      after.empty() ? catalogue->meshes.begin() : catalogue->meshes.upperBound(after), *limit};
  const ContentCoding coding = chooseCoding(request.acceptEncoding.value_or(""), true, true);
  KeptPagePointer page = mayRead ? restrictedPage(*catalogue, start, mayRead, coding, kept)
                                 : openPage(*catalogue, start, coding, kept);
  const DocumentForm& form = page->form;
  return formReply(request, form, std::move(page));
}

}  // namespace qtet
