#include "simplify/publish/publish_site.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "codec/picture/poster.h"
#include "codec/picture/poster_page.h"
#include "proto/version.h"
#include "simplify/log/opened_list.h"
#include "simplify/log/opened_log.h"
#include "simplify/publish/compressed.h"
#include "simplify/publish/hosting_notes.h"
#include "simplify/publish/site_folder.h"

namespace qtet {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* kPage = "index.html";
/// Where the page looks for its meshes (web-client/viewer/main.ts).
constexpr const char* kListElement = "<meta name=\"qtet-src\" content=\"index.json\">\n  ";

Bytes bytesOf(const std::string& text) { return {text.begin(), text.end()}; }

/// For an address: letters, digits, - . _ ~ stay (RFC 3986, "unreserved").
std::string percentEncoded(const std::string& name) {
  constexpr std::string_view kDigits = "0123456789ABCDEF", kKept = "-._~";
  std::string out;
  for (const char c : name) {
    const bool isLetter =
        (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
    const auto byte = static_cast<unsigned char>(c);
    if (isLetter || kKept.find(c) != kKept.npos)
      out += c;
    else
      (out += '%') += {kDigits[byte >> 4], kDigits[byte & 15]};
  }
  return out;
}

struct Coding {
  const char* ending;
  Result<Bytes> (*coded)(ByteView);
};

/// A folder that is being made, and how many bytes are in it.
struct Site {
  SiteFolder folder;
  bool isCoded = true;
  std::uint64_t bytes = 0;

  Status write(const std::string& name, ByteView content) {
    bytes += content.size();
    return folder.write(name, content);
  }
  /// If isCoded, also writes each coding beside it that takes fewer bytes.
  Status writeWithCodings(const std::string& name, ByteView content) {
    if (Status written = write(name, content); !written || !isCoded) return written;
    for (const auto& [ending, coded] : {Coding{".gz", gzipped}, Coding{".br", brotlied}}) {
      const Result<Bytes> small = coded(content);
      if (!small) return std::unexpected(small.error());
      if (small->size() >= content.size()) continue;
      if (Status written = write(name + ending, *small); !written) return written;
    }
    return {};
  }
};

/// Relative names of the viewer's files, ascending, without those that are compressed already:
/// these are made again.
Result<std::vector<std::string>> viewerFiles(const fs::path& viewer) {
  std::vector<std::string> names;
  std::error_code code;
  for (fs::recursive_directory_iterator at(viewer, code), end; !code && at != end;
       at.increment(code)) {
    const std::string ending = at->path().extension().string();
    const bool isOurs = ending != ".gz" && ending != ".br" && ending != ".zst";
    std::error_code unknown;
    if (at->is_regular_file(unknown) && isOurs)
      names.push_back(at->path().lexically_relative(viewer).generic_string());
  }
  std::ranges::sort(names);
  if (std::ranges::binary_search(names, kPage)) return names;
  return fail(ErrorCode::kNotFound,
              "the folder " + viewer.string() +
                  " holds no viewer (index.html); give the one of qtet-server with --viewer");
}

/// Corrects the poster where the address names another mesh (web-client/public/first.js).
constexpr const char* kFirstScript = "<script src=\"first.js\"></script>\n  ";

/// `first` is the mesh that the page shows if its address names none.
Result<Bytes> pageWithList(const Bytes& page, const std::string& first) {
  std::string text(page.begin(), page.end());
  const std::size_t end = text.find("</head>");
  if (end == text.npos)
    return fail(ErrorCode::kBadInput,
                "the viewer's index.html has no </head>; give the viewer of this version");
  text.insert(end, kListElement);
  if (const std::size_t body = text.find("</body>"); body != text.npos)
    text.insert(body, kFirstScript);
  return bytesOf(first.empty() ? text : pageOfMesh(text, first, percentEncoded(first) + ".webp"));
}

Status writeViewer(Site& site, const fs::path& viewer, const std::string& first) {
  const Result<std::vector<std::string>> names = viewerFiles(viewer);
  if (!names) return std::unexpected(names.error());
  for (const std::string& name : *names) {
    Result<Bytes> content = readWhole(viewer / name);
    if (content && name == kPage) content = pageWithList(*content, first);
    if (!content) return std::unexpected(content.error());
    if (Status written = site.writeWithCodings(name, *content); !written) return written;
  }
  return {};
}

Result<Bytes> posterOf(const OpenedLog& log) {
  const Result<LatticeMesh> mesh =
      meshAtLevel(log.file, posterLevel(log.manifest), posterFields(log.manifest));
  if (!mesh) return std::unexpected(mesh.error());
  return posterWebp(*mesh, log.manifest);
}

/// The length of the file's prefix that holds the viewer's first picture. It ends in the first
/// chunk, behind the fields that colour and move the mesh.
std::uint64_t firstBytes(const OpenedLog& log) {
  std::uint32_t last = kPositionsPart;
  for (const std::uint32_t field : posterFields(log.manifest))
    last = std::max(last, kFirstFieldPart + field);
  const BlockEntry& block = log.file.chunks().front().blocks[last];
  return block.offset + block.size;
}

/// The error names the log, one of several.
std::unexpected<Error> named(Error error, const fs::path& path) {
  if (error.message.find(path.string()) == std::string::npos)
    error.message = path.string() + ": " + error.message;
  return std::unexpected(std::move(error));
}

/// Copies the log as NAME.qtet.
Status copyLog(Site& site, const fs::path& path, const OpenedLog& log) {
  if (Status sound = log.file.verifyChecksums(); !sound) return named(sound.error(), path);
  const std::string name = path.filename().string();
  if (site.folder.files().contains(name))
    return fail(ErrorCode::kBadInput, "two logs are called " + name +
                                          ", and a folder holds one; rename " + path.string());
  return site.write(name, log.file.bytes());
}

/// The mesh `name` of index.json, which is a log that the folder holds as `file`. Makes its poster.
Result<Json> entryOf(Site& site, const std::string& name, const std::string& file,
                     const OpenedLog& log) {
  const Result<Bytes> poster = posterOf(log);
  if (!poster) return std::unexpected(poster.error());
  if (Status written = site.write(name + ".webp", *poster); !written)
    return std::unexpected(written.error());
  Json fields = Json::array();
  for (std::size_t f = 0; f < log.manifest.fields.size(); ++f)
    fields.push_back(fieldKey(log.manifest, f));
  const ManifestLevel& whole = log.manifest.levels.back();
  return Json{
      {"id", name},
      {"bytes", log.file.bytes().size()},
      {"firstBytes", firstBytes(log)},
      {"digest", log.file.digest()},
      {"tetrahedra", whole.tetrahedra},
      {"vertices", whole.vertices},
      {"fields", fields},
      {"firstField", firstField(log.manifest)},
      {"links", {{"log", percentEncoded(file)}, {"poster", percentEncoded(name) + ".webp"}}}};
}

Result<Json> writeLog(Site& site, const fs::path& path) {
  const Result<OpenedLog> log = openLog(path);
  if (!log) return named(log.error(), path);
  if (Status copied = copyLog(site, path, *log); !copied) return std::unexpected(copied.error());
  Result<Json> out = entryOf(site, path.stem().string(), path.filename().string(), *log);
  return out ? std::move(out) : named(out.error(), path);
}

/// Copies the list of segments and its logs. The list is one mesh, and says of itself what it says
/// of its first log.
Result<Json> writeSegments(Site& site, const fs::path& path) {
  const Result<SegmentList> list = openList(path);
  if (!list) return std::unexpected(list.error());
  Json out;
  Json segments = Json::array();
  std::uint64_t bytes = 0;
  for (const Segment& segment : list->segments) {
    const Result<OpenedLog> log = openSegment(path, segment);
    if (!log) return std::unexpected(log.error());
    if (Status copied = copyLog(site, path.parent_path() / segment.log, *log); !copied)
      return std::unexpected(copied.error());
    if (segments.empty()) {
      Result<Json> first = entryOf(site, path.stem().string(), segment.log, *log);
      if (!first) return named(first.error(), path);
      out = std::move(*first);
    }
    bytes += log->file.bytes().size();
    segments.push_back({{"log", segment.log}, {"times", segment.times}});
  }
  const Result<std::string> text = segmentListText(*list);
  if (!text) return std::unexpected(text.error());
  const std::string name = path.filename().string();
  if (Status written = site.writeWithCodings(name, bytesOf(*text)); !written)
    return std::unexpected(written.error());
  out["bytes"] = bytes;
  out["links"]["list"] = percentEncoded(name);
  out["segments"] = std::move(segments);
  return out;
}

Status writeList(Site& site, const Json& meshes) {
  Json list = {{"generator", "qtet " + version()}, {"meshes", meshes}};
  list["files"] = site.folder.files();
  for (const char* ending : {"", ".gz", ".br"})
    list["files"].push_back(std::string(kSiteList) + ending);
  return site.writeWithCodings(
      kSiteList, bytesOf(list.dump(1, ' ', false, Json::error_handler_t::replace) + "\n"));
}

}  // namespace

Result<PublishedSite> publishSite(const fs::path& folder, const fs::path& viewer,
                                  const std::vector<fs::path>& logs, Codings codings) {
  Result<SiteFolder> begun = SiteFolder::begin(folder);
  if (!begun) return std::unexpected(begun.error());
  Site site{std::move(*begun), codings == Codings::kGzipAndBrotli};
  PublishedSite out;
  Json meshes = Json::array();
  for (const fs::path& path : logs) {
    const Result<Json> mesh =
        isSegmentList(path) ? writeSegments(site, path) : writeLog(site, path);
    if (!mesh) return std::unexpected(mesh.error());
    meshes.push_back(*mesh);
    out.meshes.push_back({(*mesh)["id"], (*mesh)["bytes"], (*mesh)["tetrahedra"]});
  }
  Status status = writeViewer(site, viewer, out.meshes.empty() ? "" : out.meshes.front().name);
  if (status) status = site.write("README.txt", bytesOf(hostingNotes()));
  if (status) status = site.write(".nojekyll", {});
  if (status) status = writeList(site, meshes);
  if (status) status = site.folder.finish();
  if (!status) return std::unexpected(status.error());
  out.files = site.folder.files().size();
  out.bytes = site.bytes;
  return out;
}

}  // namespace qtet
