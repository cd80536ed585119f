#include "server/routes/viewer_files.h"

#include <spdlog/spdlog.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <utility>

#include "server/http/http_resource.h"
#include "server/routes/viewer_limits.h"
#include "server/wire/digest.h"

namespace qtet {
namespace {

namespace fs = std::filesystem;

constexpr std::array<std::pair<std::string_view, std::string_view>, 16> kTypes = {{
    {".html", "text/html; charset=utf-8"},
    {".js", "text/javascript; charset=utf-8"},
    {".mjs", "text/javascript; charset=utf-8"},
    {".css", "text/css; charset=utf-8"},
    {".wasm", "application/wasm"},
    {".json", "application/json"},
    {".map", "application/json"},
    {".webmanifest", "application/manifest+json"},
    {".svg", "image/svg+xml"},
    {".png", "image/png"},
    {".jpg", "image/jpeg"},
    {".ico", "image/x-icon"},
    {".woff2", "font/woff2"},
    {".txt", "text/plain; charset=utf-8"},
    {".qtet", "application/octet-stream"},
    {".vtu", "application/octet-stream"},
}};

std::string_view typeOf(const fs::path& path) {
  const std::string extension = path.extension().string();
  const auto it =
      std::ranges::find(kTypes, extension, &std::pair<std::string_view, std::string_view>::first);
  return it == kTypes.end() ? "application/octet-stream" : it->second;
}

/// Whether the file that `path` leads to, links resolved, lies below `root` (resolved already).
bool liesBelow(const fs::path& path, const fs::path& root) {
  std::error_code ec;
  const fs::path real = fs::canonical(path, ec);
  return !ec && std::ranges::mismatch(root, real).in1 == root.end();
}

Result<Bytes> readWhole(const fs::path& path, std::uintmax_t size) {
  std::ifstream in(path, std::ios::binary);
  Bytes out(size);
  in.read(reinterpret_cast<char*>(out.data()), static_cast<std::streamsize>(size));
  if (!in || static_cast<std::uintmax_t>(in.gcount()) != size)
    return fail(ErrorCode::kIo, path.string() + " cannot be read; check its permissions");
  return out;
}

Result<ViewerFile> readFile(const fs::path& path, const std::string& name, std::uintmax_t size) {
  Result<Bytes> bytes = readWhole(path, size);
  if (!bytes) return std::unexpected(bytes.error());
  struct stat info{};
  const std::time_t modified = ::stat(path.c_str(), &info) == 0 ? info.st_mtime : 0;
  std::string etag = '"' + hexDigestOf(*bytes) + '"';
  return ViewerFile{
      std::move(*bytes),          {}, {}, std::string(typeOf(path)), std::move(etag), modified,
      name.starts_with("assets/")};
}

/// Kinds of files that compressing makes smaller.
bool isText(std::string_view type) {
  return type.starts_with("text/") || type == "application/json" || type == "image/svg+xml" ||
         type == "application/wasm" || type == "application/manifest+json";
}

bool hidden(const fs::path& path) { return path.filename().native().starts_with('.'); }

}  // namespace

Result<ViewerFiles> ViewerFiles::load(const fs::path& folder) {
  std::error_code ec;
  const fs::path root = fs::canonical(folder, ec);
  ViewerFiles out;
  std::uintmax_t total = 0;
  for (fs::recursive_directory_iterator it(root, ec), end; !ec && it != end; it.increment(ec)) {
    if (hidden(it->path())) {
      it.disable_recursion_pending();
      continue;
    }
    std::error_code unreadable;
    if (!it->is_regular_file(unreadable) || !liesBelow(it->path(), root)) continue;
    const std::string name = it->path().lexically_relative(root).generic_string();
    const std::uintmax_t size = it->file_size(unreadable);
    if (unreadable) continue;
    total += size;
    if (out.files_.size() >= limits::kMaxViewerFiles || total > limits::kMaxViewerBytes)
      return fail(ErrorCode::kLimitExceeded,
                  folder.string() + " holds more than " + std::to_string(limits::kMaxViewerFiles) +
                      " files or " + std::to_string(limits::kMaxViewerBytes) +
                      " bytes; name the built viewer's folder");
    Result<ViewerFile> file = readFile(it->path(), name, size);
    if (!file) return std::unexpected(file.error());
    out.files_.emplace(name, std::move(*file));
  }
  out.attach(".gz", ContentCoding::kGzip, &CodedFile::gzip);
  out.attach(".zst", ContentCoding::kZstd, &CodedFile::zstd);
  if (ec)
    return fail(ErrorCode::kIo,
                folder.string() + ": " + ec.message() + "; name the built viewer's folder");
  if (!out.files_.contains("index.html"))
    return fail(ErrorCode::kIo,
                folder.string() + " holds no index.html; name the built viewer's folder");
  return out;
}

void ViewerFiles::attach(std::string_view suffix, ContentCoding coding, Bytes CodedFile::* form) {
  for (auto it = files_.begin(); it != files_.end();) {
    const std::string_view name = it->first;
    const auto original = name.ends_with(suffix)
                              ? files_.find(name.substr(0, name.size() - suffix.size()))
                              : files_.end();
    if (original == files_.end()) {
      ++it;
      continue;
    }
    if (isCodingOf(it->second.bytes, coding, original->second.bytes))
      original->second.built.*form = std::move(it->second.bytes);
    else
      spdlog::warn("the viewer's {} is not {} compressed; build the viewer again", name,
                   original->first);
    it = files_.erase(it);
  }
}

Variants ViewerFiles::variantsOf(const ViewerFile& file) const {
  const bool rest = restIsThere_->load(std::memory_order_acquire);
  const auto form = [&](Bytes CodedFile::* which) {
    const Bytes& built = file.built.*which;
    return !built.empty() || !rest ? ByteView(built) : ByteView(file.late.*which);
  };
  return {file.bytes, form(&CodedFile::gzip), form(&CodedFile::zstd)};
}

void ViewerFiles::compressRest(const std::stop_token& stop) {
  for (auto& [name, file] : files_) {
    if (stop.stop_requested()) return;
    if (!isText(file.type) || file.bytes.size() < kMinCompressedBytes) continue;
    if (file.built.gzip.empty()) file.late.gzip = compressed(file.bytes, ContentCoding::kGzip);
    if (!file.built.zstd.empty()) continue;
    file.late.zstd = compressed(file.bytes, ContentCoding::kZstd);
    // Clients that take both get this one.
    if (const Bytes& gzip = file.built.gzip; !gzip.empty() && file.late.zstd.size() >= gzip.size())
      file.late.zstd.clear();
  }
  restIsThere_->store(true, std::memory_order_release);
}

const ViewerFile* ViewerFiles::find(std::string_view path) const {
  std::string name(path);
  if (name.empty() || name.ends_with('/')) name += "index.html";
  const auto it = files_.find(name);
  return it == files_.end() ? nullptr : &it->second;
}

}  // namespace qtet
