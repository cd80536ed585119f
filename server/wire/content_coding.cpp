#include "server/wire/content_coding.h"

#include <libdeflate.h>
#include <zstd.h>

#include <algorithm>
#include <cassert>
#include <cctype>
#include <memory>
#include <optional>

#include "server/wire/blanks.h"

namespace qtet {
namespace {

/// Levels at which a level of 100 MB takes two or three seconds: higher ones gain 1-2 % of floats.
constexpr int kGzipLevel = 6;
constexpr int kZstdLevel = 6;

bool equalsIgnoringCase(std::string_view a, std::string_view b) {
  return std::ranges::equal(
      a, b, [](unsigned char x, unsigned char y) { return std::tolower(x) == std::tolower(y); });
}

/// Thousandths of "q=0.5"; 1000 where there is no weight, or one that cannot be read.
int weightOf(std::string_view parameters) {
  const std::string_view q = trimmed(parameters, kHeaderBlanks);
  if (q.size() < 3 || !equalsIgnoringCase(q.substr(0, 2), "q=") || (q[2] != '0' && q[2] != '1'))
    return 1000;
  int out = q[2] == '1' ? 1000 : 0;
  int unit = 100;
  for (const char digit : q.substr(std::min<std::size_t>(4, q.size()))) {
    if (digit < '0' || digit > '9') break;
    out += (digit - '0') * unit;
    unit /= 10;
  }
  return std::min(out, 1000);
}

Bytes gzipped(ByteView bytes) {
  const std::unique_ptr<libdeflate_compressor, decltype(&libdeflate_free_compressor)> compressor(
      libdeflate_alloc_compressor(kGzipLevel), libdeflate_free_compressor);
  if (!compressor) return {};
  Bytes out(libdeflate_gzip_compress_bound(compressor.get(), bytes.size()));
  out.resize(libdeflate_gzip_compress(compressor.get(), bytes.data(), bytes.size(), out.data(),
                                      out.size()));
  out.shrink_to_fit();  // some are kept
  return out;
}

Bytes zstandard(ByteView bytes) {
  Bytes out(ZSTD_compressBound(bytes.size()));
  const std::size_t size =
      ZSTD_compress(out.data(), out.size(), bytes.data(), bytes.size(), kZstdLevel);
  out.resize(ZSTD_isError(size) != 0 ? 0 : size);
  return out;
}

/// Bytes written to `out`; nullopt: they are more, or `coded` is not one whole gzip member.
std::optional<std::size_t> inflated(ByteView coded, Bytes& out) {
  const std::unique_ptr<libdeflate_decompressor, decltype(&libdeflate_free_decompressor)> with(
      libdeflate_alloc_decompressor(), libdeflate_free_decompressor);
  std::size_t taken = 0, size = 0;
  const bool sound =
      with && libdeflate_gzip_decompress_ex(with.get(), coded.data(), coded.size(), out.data(),
                                            out.size(), &taken, &size) == LIBDEFLATE_SUCCESS;
  return sound && taken == coded.size() ? std::optional(size) : std::nullopt;
}

/// The same of whole Zstandard frames.
std::optional<std::size_t> decodedZstd(ByteView coded, Bytes& out) {
  const std::size_t size = ZSTD_decompress(out.data(), out.size(), coded.data(), coded.size());
  return ZSTD_isError(size) != 0 ? std::nullopt : std::optional(size);
}

}  // namespace

std::string_view codingName(ContentCoding coding) {
  switch (coding) {
    case ContentCoding::kGzip: return "gzip";
    case ContentCoding::kZstd: return "zstd";
    case ContentCoding::kIdentity: break;
  }
  return "";
}

ContentCoding chooseCoding(std::string_view acceptEncoding, bool gzip, bool zstd) {
  std::optional<int> gzipWeight, zstdWeight, identityWeight, any;
  while (!acceptEncoding.empty()) {
    const std::size_t comma = std::min(acceptEncoding.find(','), acceptEncoding.size());
    const std::string_view item = acceptEncoding.substr(0, comma);
    acceptEncoding.remove_prefix(std::min(comma + 1, acceptEncoding.size()));
    const std::size_t semicolon = std::min(item.find(';'), item.size());
    const std::string_view coding = trimmed(item.substr(0, semicolon), kHeaderBlanks);
    const int weight = semicolon == item.size() ? 1000 : weightOf(item.substr(semicolon + 1));
    if (equalsIgnoringCase(coding, "gzip") || equalsIgnoringCase(coding, "x-gzip"))
      gzipWeight = weight;
    if (equalsIgnoringCase(coding, "zstd")) zstdWeight = weight;
    if (equalsIgnoringCase(coding, "identity")) identityWeight = weight;
    if (coding == "*") any = weight;
  }
  // Identity is acceptable unless it is refused by name or by *; nothing is gained by sending it
  // where a coding is taken as gladly.
  ContentCoding out = ContentCoding::kIdentity;
  int best = identityWeight.value_or(any ? *any : 0);
  const auto offer = [&](bool there, const std::optional<int>& named, ContentCoding coding) {
    const int weight = named.value_or(any.value_or(0));
    if (!there || weight == 0 || weight < best) return;
    best = weight;
    out = coding;
  };
  offer(gzip, gzipWeight, ContentCoding::kGzip);
  offer(zstd, zstdWeight, ContentCoding::kZstd);
  return out;
}

Bytes encoded(Bytes bytes, ContentCoding coding) {
  if (coding == ContentCoding::kIdentity) return bytes;
  return coding == ContentCoding::kGzip ? gzipped(bytes) : zstandard(bytes);
}

Bytes compressed(ByteView bytes, ContentCoding coding) {
  assert(coding != ContentCoding::kIdentity);
  Bytes out = coding == ContentCoding::kGzip ? gzipped(bytes) : zstandard(bytes);
  return out.size() < bytes.size() ? out : Bytes();
}

bool isCodingOf(ByteView coded, ContentCoding coding, ByteView bytes) {
  assert(coding != ContentCoding::kIdentity);
  Bytes out(bytes.size() + 1);  // room for a byte too many
  const std::optional<std::size_t> size =
      coding == ContentCoding::kGzip ? inflated(coded, out) : decodedZstd(coded, out);
  return size == bytes.size() && std::equal(bytes.begin(), bytes.end(), out.begin());
}

}  // namespace qtet
