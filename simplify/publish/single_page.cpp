#include "simplify/publish/single_page.h"

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>

#include "codec/log/log_index.h"
#include "codec/picture/poster_page.h"
#include "proto/text_bytes.h"
#include "simplify/log/opened_log.h"
#include "simplify/publish/compressed.h"
#include "simplify/publish/site_folder.h"

namespace qtet {
namespace {

namespace fs = std::filesystem;

constexpr const char* kPageScript = "single_page.js";
/// The page's policy and files, and their types (web-client/viewer_files.ts).
constexpr const char* kViewerFiles = "viewer.json";
constexpr std::string_view kLogType = "application/octet-stream";
/// For the list of meshes and what stands around the parts, in bytes.
constexpr std::uint64_t kOverhead = 8 << 10;

std::string textOf(const Bytes& bytes) { return {bytes.begin(), bytes.end()}; }

/// RFC 4648, section 4.
std::string base64(ByteView bytes) {
  constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  out.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t at = 0; at < bytes.size(); at += 3) {
    const std::size_t here = std::min<std::size_t>(3, bytes.size() - at);
    std::uint32_t bits = 0;
    for (std::size_t i = 0; i < 3; ++i) bits = bits << 8 | (i < here ? bytes[at + i] : 0u);
    for (std::size_t i = 0; i < 4; ++i) out += i <= here ? kDigits[bits >> (18 - 6 * i) & 63] : '=';
  }
  return out;
}

/// A script element that no browser runs: the packed file. (A log is compressed already.)
Result<std::string> partOf(const std::string& name, std::string_view type, ByteView content) {
  const bool isPacked = type != kLogType;
  Result<Bytes> packed = isPacked ? gzipped(content) : Bytes();
  if (!packed) return std::unexpected(packed.error());
  return "<script type=\"application/octet-stream\" data-name=\"" + htmlEscaped(name) +
         "\" data-type=\"" + std::string(type) + "\" data-size=\"" +
         std::to_string(content.size()) + (isPacked ? "\" data-coding=\"gzip" : "") + "\">" +
         base64(isPacked ? ByteView(*packed) : content) + "</script>\n";
}

/// Takes the elements that begin with `tag` out, up to `end`. Returns the first one.
std::string takeOut(std::string& page, std::string_view tag, std::string_view end) {
  std::string first;
  for (std::size_t at = 0; (at = page.find(tag, at)) != page.npos;) {
    const std::size_t behind = std::min(page.find(end, at), page.size() - end.size()) + end.size();
    if (first.empty()) first = page.substr(at, behind - at);
    page.erase(at, behind - at);
  }
  return first;
}

/// The value of an attribute; empty without it.
std::string attributeOf(const std::string& element, const std::string& name) {
  const std::size_t at = element.find(name + "=\"");
  if (at == element.npos) return {};
  const std::size_t from = at + name.size() + 2;
  return element.substr(from, element.find('"', from) - from);
}

void insertBefore(std::string& page, std::string_view tag, const std::string& text) {
  if (const std::size_t at = page.find(tag); at != page.npos) page.insert(at, text);
}

/// The poster itself instead of its address.
Status inlinePoster(std::string& page, const fs::path& site, const std::string& poster) {
  const std::size_t image = page.find("<img slot=\"poster\"");
  const std::size_t at = image == page.npos ? image : page.find(" src=\"", image);
  if (at == page.npos) return {};
  const Result<Bytes> picture = readWhole(site / poster);
  if (!picture) return std::unexpected(picture.error());
  const std::size_t from = at + std::string_view(" src=\"").size();
  page.replace(from, page.find('"', from) - from, "data:image/webp;base64," + base64(*picture));
  return {};
}

Result<nlohmann::json> listOf(const fs::path& site) {
  const Result<Bytes> text = readWhole(site / kSiteList);
  if (!text) return std::unexpected(text.error());
  return nlohmann::json::parse(textOf(*text));
}

Error lacks(const char* file) {
  return {ErrorCode::kBadInput,
          std::string("the viewer has no ") + file + "; give that of this version"};
}

Error isOfAnotherVersion() {
  return {ErrorCode::kBadInput, std::string("the viewer's ") + kViewerFiles +
                                    " is of another version; give that of this version"};
}

struct ViewerFiles {
  std::string policy;
  std::map<std::string, std::string> types;  ///< of each file that the page holds
};

Result<ViewerFiles> viewerFilesOf(const fs::path& site) {
  const Result<Bytes> text = readWhole(site / kViewerFiles);
  if (!text) return std::unexpected(lacks(kViewerFiles));
  const nlohmann::json files = nlohmann::json::parse(textOf(*text), nullptr, false);
  const auto has = [&](const char* key) { return files.is_object() && files.contains(key); };
  if (!has("policy") || !files["policy"].is_string() || !has("page") || !files["page"].is_object())
    return std::unexpected(isOfAnotherVersion());
  ViewerFiles out{files["policy"], {}};
  for (const auto& [name, type] : files["page"].items()) {
    if (!type.is_string()) return std::unexpected(isOfAnotherVersion());
    out.types.emplace(name, type);
  }
  return out;
}

/// A page in pieces: what stands in its head, and the packed files.
struct Pieces {
  std::string styles, icon, parts;
  std::size_t count = 0;

  Status add(const std::string& name, std::string_view type, ByteView content) {
    if (type == "text/css") {
      (styles += "<style>").append(content.begin(), content.end()) += "</style>\n  ";
    } else if (type == "image/svg+xml") {
      icon = "<link rel=\"icon\" href=\"data:image/svg+xml;base64," + base64(content) + "\">\n  ";
    } else {
      const Result<std::string> part = partOf(name, type, content);
      if (!part) return std::unexpected(part.error());
      parts += *part;
      ++count;
    }
    return {};
  }
};

/// How many leading chunks end within so many bytes of the log.
std::uint32_t chunksWithin(std::span<const ChunkEntry> all, std::uint64_t bytes) {
  std::uint32_t count = 0;
  for (const ChunkEntry& chunk : all) {
    if (chunk.offset + chunk.size() > bytes) break;
    ++count;
  }
  return count;
}

/// Cuts the log to the chunks with which the page has at most `most` bytes, `other` of them without
/// it. Returns their number, 0 for all, and notes the cut in the list.
Result<std::uint32_t> cutLog(Bytes& content, const fs::path& path, std::uint64_t most,
                             std::uint64_t other, nlohmann::json& list) {
  const std::uint64_t room = most > other ? (most - other) / 4 * 3 : 0;
  if (content.size() <= room) return 0;
  const Result<OpenedLog> log = openLog(path);
  if (!log) return std::unexpected(log.error());
  const std::span<const ChunkEntry> all = log->file.chunks();
  const Bytes later = log->file.index().encodeLater();  // the end of the log, and of what is left
  const std::uint32_t chunks = chunksWithin(all, room > later.size() ? room - later.size() : 0);
  if (chunks == 0) {
    const std::uint64_t base = all.front().offset + all.front().size() + later.size();
    return fail(ErrorCode::kLimitExceeded,
                "the smallest page of this log, with the base mesh, has " +
                    std::to_string(other + (base + 2) / 3 * 4) + " bytes; allow so many");
  }
  const ChunkEntry& last = all[chunks - 1];
  content.resize(last.offset + last.size());
  content.insert(content.end(), later.begin(), later.end());
  list["meshes"][0]["chunks"] = chunks;
  return chunks;
}

}  // namespace

Result<SinglePage> singlePage(const fs::path& site, const SinglePageOptions& options) {
  Result<nlohmann::json> list = listOf(site);
  const Result<Bytes> viewer = readWhole(site / "index.html");
  const Result<Bytes> first = readWhole(site / kPageScript);
  const Result<ViewerFiles> files = viewerFilesOf(site);
  if (!list) return std::unexpected(list.error());
  if (!viewer) return std::unexpected(viewer.error());
  if (!first) return std::unexpected(lacks(kPageScript));
  if (!files) return std::unexpected(files.error());
  std::string page = textOf(*viewer);
  const std::string entry =
      fs::path(attributeOf(takeOut(page, "<script", "</script>"), "src")).filename().string();
  takeOut(page, "<link", ">");

  Pieces pieces;
  for (const auto& [name, type] : files->types) {
    const Result<Bytes> content = readWhole(site / name);
    if (!content) return std::unexpected(content.error());
    if (Status added = pieces.add(name, type, *content); !added)
      return std::unexpected(added.error());
  }
  std::string logName;
  for (const std::string name : list->at("files"))
    if (name.ends_with(".qtet")) logName = name;
  const std::string poster = list->at("meshes").at(0).at("links").at("poster");
  if (Status inlined = inlinePoster(page, site, poster); !inlined)
    return std::unexpected(inlined.error());

  Result<Bytes> log = readWhole(site / logName);
  if (!log) return std::unexpected(log.error());
  const std::uint64_t most = std::min(options.maxBytes.value_or(kMaxPageBytes), kMaxPageBytes);
  const std::uint64_t other = page.size() + first->size() + pieces.parts.size() +
                              pieces.styles.size() + pieces.icon.size() +
                              htmlEscaped(options.view).size() + kOverhead;
  const Result<std::uint32_t> chunks = cutLog(*log, site / logName, most, other, *list);
  if (!chunks) return std::unexpected(chunks.error());
  if (Status added = pieces.add(kSiteList, "application/json", viewOf(list->dump())); !added)
    return std::unexpected(added.error());
  if (Status added = pieces.add(logName, kLogType, *log); !added)
    return std::unexpected(added.error());

  insertBefore(
      page, "<meta name",
      "<meta http-equiv=\"Content-Security-Policy\" content=\"" + files->policy + "\">\n  ");
  if (!options.view.empty())
    insertBefore(page, "</head>",
                 "<meta name=\"qtet-view\" content=\"" + htmlEscaped(options.view) + "\">\n  ");
  insertBefore(page, "</head>",
               pieces.icon + pieces.styles + "<script data-parts=\"" +
                   std::to_string(pieces.count) + "\" data-entry=\"" + entry + "\">" +
                   textOf(*first) + "</script>\n  ");
  insertBefore(page, "</body>", pieces.parts);
  return SinglePage{Bytes(page.begin(), page.end()), *chunks};
}

}  // namespace qtet
