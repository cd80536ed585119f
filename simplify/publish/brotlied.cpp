#include <brotli/encode.h>

#include "simplify/publish/compressed.h"

namespace qtet {

Result<Bytes> brotlied(ByteView bytes) {
  std::size_t size = BrotliEncoderMaxCompressedSize(bytes.size());
  Bytes out(size);
  if (BrotliEncoderCompress(BROTLI_MAX_QUALITY, BROTLI_MAX_WINDOW_BITS, BROTLI_MODE_GENERIC,
                            bytes.size(), bytes.data(), &size, out.data()) != BROTLI_TRUE)
    return fail(ErrorCode::kIo, "there is no memory to compress a file with Brotli");
  out.resize(size);
  return out;
}

}  // namespace qtet
