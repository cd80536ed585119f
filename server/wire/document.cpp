#include "server/wire/document.h"

#include "server/wire/content_coding.h"
#include "server/wire/digest.h"

namespace qtet {

Document::Document(std::string content) : text(std::move(content)) {
  const ByteView bytes = {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
  etag = '"' + hexDigestOf(bytes) + '"';
  if (bytes.size() < kMinCompressedBytes) return;
  gzip = compressed(bytes, ContentCoding::kGzip);
  zstd = compressed(bytes, ContentCoding::kZstd);
}

}  // namespace qtet
