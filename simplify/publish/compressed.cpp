#include "simplify/publish/compressed.h"

#include <brotli/encode.h>
#include <libdeflate.h>

#include <memory>

namespace qtet {
namespace {

constexpr int kBestGzip = 12;  // libdeflate's slowest: once for files that are sent often

Error noRoom(const char* coding) {
  return {ErrorCode::kIo, std::string("there is no memory to compress a file with ") + coding,
          Error::kNoOffset};
}

}  // namespace

Result<Bytes> gzipped(ByteView bytes) {
  const std::unique_ptr<libdeflate_compressor, decltype(&libdeflate_free_compressor)> compressor(
      libdeflate_alloc_compressor(kBestGzip), libdeflate_free_compressor);
  if (!compressor) return std::unexpected(noRoom("gzip"));
  Bytes out(libdeflate_gzip_compress_bound(compressor.get(), bytes.size()));
  out.resize(libdeflate_gzip_compress(compressor.get(), bytes.data(), bytes.size(), out.data(),
                                      out.size()));
  return out;
}

Result<Bytes> brotlied(ByteView bytes) {
  std::size_t size = BrotliEncoderMaxCompressedSize(bytes.size());
  Bytes out(size);
  if (BrotliEncoderCompress(BROTLI_MAX_QUALITY, BROTLI_MAX_WINDOW_BITS, BROTLI_MODE_GENERIC,
                            bytes.size(), bytes.data(), &size, out.data()) != BROTLI_TRUE)
    return std::unexpected(noRoom("Brotli"));
  out.resize(size);
  return out;
}

}  // namespace qtet
