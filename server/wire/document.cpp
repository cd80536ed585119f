#include "server/wire/document.h"

#include <cassert>
#include <utility>

#include "server/wire/digest.h"

namespace qtet {

DocumentForm formOf(Resource resource, Bytes bytes, ContentCoding coding) {
  becomeVariant(resource, coding);
  DocumentForm out;
  out.headers = headOf(resource);
  out.validators = std::move(resource.validators);
  out.bytes = std::move(bytes);
  return out;
}

Document::Document(std::string_view text, Resource about) {
  assert(about.validators.etag.empty());
  Bytes bytes(text.begin(), text.end());
  about.validators.etag = '"' + tagOf(bytes) + '"';
  if (bytes.size() >= kMinCompressedBytes) {
    if (Bytes packed = compressed(bytes, ContentCoding::kGzip); !packed.empty())
      gzip = formOf(about, std::move(packed), ContentCoding::kGzip);
    if (Bytes packed = compressed(bytes, ContentCoding::kZstd); !packed.empty())
      zstd = formOf(about, std::move(packed), ContentCoding::kZstd);
  }
  if (gzip || zstd) {
    identity = formOf(std::move(about), std::move(bytes), ContentCoding::kIdentity);
  } else {  // the same for all: no Vary
    identity.headers = headOf(about);
    identity.validators = std::move(about.validators);
    identity.bytes = std::move(bytes);
  }
}

const DocumentForm& Document::form(ContentCoding coding) const {
  if (coding == ContentCoding::kIdentity) return identity;
  const std::optional<DocumentForm>& out = coding == ContentCoding::kGzip ? gzip : zstd;
  assert(out);
  return *out;
}

}  // namespace qtet
