#include "server/wire/resource.h"

#include "server/wire/http_date.h"

namespace qtet {

HeaderLines headOf(const Resource& resource) {
  HeaderLines out = {{"ETag", resource.validators.etag},
                     {"Last-Modified", httpDate(resource.validators.modified)},
                     {"Cache-Control", resource.cacheControl}};
  addType(out, resource.type);
  out.add(resource.headers);
  addCommonHeaders(out);
  return out;
}

void becomeVariant(Resource& resource, ContentCoding coding) {
  resource.headers.add("Vary", "Accept-Encoding");
  if (coding == ContentCoding::kIdentity) return;
  const std::string_view name = codingName(coding);
  // other bytes, another strong tag
  resource.validators.plainEtag = resource.validators.etag;
  resource.validators.etag.insert(resource.validators.etag.size() - 1, "-" + std::string(name));
  resource.headers.add("Content-Encoding", name);
}

void becomeMeasurable(Resource& resource) { resource.headers.add("Timing-Allow-Origin", "*"); }

void becomeEmbeddable(Resource& resource) {
  becomeMeasurable(resource);
  resource.headers.add("Cross-Origin-Resource-Policy", "cross-origin");
}

}  // namespace qtet
