#include "server/routes/first_page.h"

#include <algorithm>
#include <array>
#include <tuple>
#include <utility>

#include "codec/picture/poster_page.h"
#include "server/http/http_resource.h"
#include "server/wire/digest.h"

namespace qtet {
namespace {

/// Names of the address that leave the first picture as it is.
constexpr std::array<std::string_view, 2> kHarmless = {"mesh", "transport"};

bool saysMore(std::string_view query) {
  for (; !query.empty();) {
    const std::string_view pair = query.substr(0, query.find('&'));
    query.remove_prefix(std::min(pair.size() + 1, query.size()));
    const std::string_view name = pair.substr(0, pair.find('='));
    if (!name.empty() && std::ranges::find(kHarmless, name) == kHarmless.end()) return true;
  }
  return false;
}

/// The value of an attribute in quotes, in a tag of the viewer's own page.
std::string_view attribute(std::string_view tag, std::string_view name) {
  const std::size_t at = tag.find(" " + std::string(name) + "=\"");
  if (at == tag.npos) return "";
  const std::string_view rest = tag.substr(at + name.size() + 3);
  return rest.substr(0, rest.find('"'));
}

/// One element's entry; empty if it is nothing that a browser could fetch early.
std::string linkOf(std::string_view tag) {
  std::string_view rel = attribute(tag, "rel"), as = attribute(tag, "as"),
                   address = attribute(tag, "href");
  if (tag.starts_with("<script"))
    std::tie(rel, address) = std::pair("modulepreload", attribute(tag, "src"));
  if (rel == "stylesheet") std::tie(rel, as) = std::pair("preload", "style");
  if (address.empty() || (rel != "preload" && rel != "modulepreload" && rel != "prefetch"))
    return "";
  std::string out = "<" + std::string(address) + ">; rel=" + std::string(rel);
  if (!as.empty()) out += "; as=" + std::string(as);
  if (tag.find(" crossorigin") != tag.npos) out += "; crossorigin";
  if (const std::string_view priority = attribute(tag, "fetchpriority"); !priority.empty())
    out += "; fetchpriority=" + std::string(priority);
  return out;
}

/// As the browser resolves it against the page.
std::string posterAddress(const MeshEntry& mesh) {
  return "v1/logs/" + mesh.digest + "/poster.webp";
}

}  // namespace

EntryPointer meshOfPage(const RequestTarget& target, const Catalogue& catalogue,
                        const MayRead& mayRead) {
  if (saysMore(target.query)) return nullptr;
  const auto readable = [&](const EntryPointer& entry) { return !mayRead || mayRead(entry->id); };
  const std::optional<std::string> id = target.parameter("mesh");
  if (id && !id->empty()) {
    const EntryPointer* found = catalogue.meshes.find(*id);
    return found != nullptr && readable(*found) ? *found : nullptr;
  }
  if (!catalogue.complete()) return nullptr;
  for (auto at = catalogue.meshes.begin(); at != catalogue.meshes.end(); ++at)
    if (readable(*at)) return *at;
  return nullptr;
}

std::string linksOf(std::string_view page) {
  std::string out;
  for (std::size_t at = page.find('<'); at != page.npos; at = page.find('<', at + 1)) {
    const std::string_view tag = page.substr(at, page.find('>', at) - at);
    if (!tag.starts_with("<link ") && !tag.starts_with("<script ")) continue;
    const std::string link = linkOf(tag);
    if (!link.empty()) out += (out.empty() ? "" : ", ") + link;
  }
  return out;
}

Reply pageReply(const RequestView& request, const ViewerFile& page, const MeshEntry& mesh,
                const std::string& links, Resource resource, KeptPages& kept) {
  const ContentCoding coding = chooseCoding(request.acceptEncoding.value_or(""), true, true);
  const std::string key =
      page.etag + " " + mesh.digest + " " + mesh.id + " " + std::string(codingName(coding));
  KeptPagePointer made = kept.find(key);
  if (!made) {
    const std::string_view plain{reinterpret_cast<const char*>(page.bytes.data()),
                                 page.bytes.size()};
    const std::string text = pageOfMesh(plain, mesh.id, posterAddress(mesh));
    resource.validators = {'"' + tagOf(text) + '"',
                           std::max(page.modified, mesh.file.modified.tv_sec)};
    const std::string poster =
        "<" + posterAddress(mesh) + ">; rel=preload; as=image; fetchpriority=high";
    resource.headers.add("Link", links.empty() ? poster : links + ", " + poster);
    made = std::make_shared<const KeptPage>(
        KeptPage{formOf(std::move(resource), encoded({text.begin(), text.end()}, coding), coding)});
    kept.keep(key, made);
  }
  return formReply(request, made->form, made);
}

}  // namespace qtet
