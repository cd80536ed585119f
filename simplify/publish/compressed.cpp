#include "simplify/publish/compressed.h"

#include <libdeflate.h>

#include <memory>

namespace qtet {
namespace {

constexpr int kBestGzip = 12;  // libdeflate's slowest: once for files that are sent often

}  // namespace

Result<Bytes> gzipped(ByteView bytes) {
  const std::unique_ptr<libdeflate_compressor, decltype(&libdeflate_free_compressor)> compressor(
      libdeflate_alloc_compressor(kBestGzip), libdeflate_free_compressor);
  if (!compressor) return fail(ErrorCode::kIo, "there is no memory to compress a file with gzip");
  Bytes out(libdeflate_gzip_compress_bound(compressor.get(), bytes.size()));
  out.resize(libdeflate_gzip_compress(compressor.get(), bytes.data(), bytes.size(), out.data(),
                                      out.size()));
  return out;
}

}  // namespace qtet
