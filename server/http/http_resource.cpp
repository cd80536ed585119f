#include "server/http/http_resource.h"

namespace qtet {

Reply beginReply(unsigned status, const Resource& resource) {
  Reply out;
  out.status = status;
  out.headers = {{"ETag", resource.validators.etag},
                 {"Last-Modified", httpDate(resource.validators.modified)},
                 {"Cache-Control", std::string(resource.cacheControl)}};
  if (status != 304) out.headers.emplace_back("Content-Type", resource.type);
  out.headers.insert(out.headers.end(), resource.headers.begin(), resource.headers.end());
  addCommonHeaders(out);
  return out;
}

std::optional<Reply> conditionalReply(const RequestView& request, const Resource& resource) {
  switch (evaluateConditions(request, resource.validators)) {
    case Verdict::kSend: return std::nullopt;
    case Verdict::kNotModified: return beginReply(304, resource);
    case Verdict::kPreconditionFailed: break;
  }
  return problem(412, "precondition-failed",
                 "the resource is another one by now: its ETag is " + resource.validators.etag);
}

Reply rangeReply(const RequestView& request, Reply begun, ByteView bytes,
                 std::shared_ptr<const void> owner) {
  const std::string date = begun.header("Last-Modified");
  const ByteRange range =
      selectRange(request, {begun.header("ETag"), parseHttpDate(date).value_or(0)}, bytes.size());
  const std::string size = std::to_string(bytes.size());
  if (range.kind == ByteRange::Kind::kUnsatisfiable) {
    Reply out = problem(416, "range-not-satisfiable",
                        "the range starts behind the end; there are " + size + " bytes");
    out.headers.emplace_back("Content-Range", "bytes */" + size);
    return out;
  }
  begun.owner = std::move(owner);
  begun.body = bytes;
  if (range.kind == ByteRange::Kind::kWhole) return begun;
  begun.status = 206;
  begun.headers.emplace_back("Content-Range", "bytes " + std::to_string(range.first) + "-" +
                                                  std::to_string(range.first + range.size - 1) +
                                                  "/" + size);
  begun.body = bytes.subspan(range.first, range.size);
  return begun;
}

Reply bytesReply(const RequestView& request, const Resource& resource, ByteView bytes,
                 std::shared_ptr<const void> owner) {
  if (std::optional<Reply> early = conditionalReply(request, resource)) return std::move(*early);
  Reply begun = beginReply(200, resource);
  begun.headers.emplace_back("Accept-Ranges", "bytes");
  return rangeReply(request, std::move(begun), bytes, std::move(owner));
}

void becomeVariant(Resource& resource, ContentCoding coding) {
  resource.headers.emplace_back("Vary", "Accept-Encoding");
  if (coding == ContentCoding::kIdentity) return;
  const std::string name(codingName(coding));
  // other bytes, another strong tag
  resource.validators.plainEtag = resource.validators.etag;
  resource.validators.etag.insert(resource.validators.etag.size() - 1, "-" + name);
  resource.headers.emplace_back("Content-Encoding", name);
}

Reply variantReply(const RequestView& request, Resource resource, const Variants& variants,
                   std::shared_ptr<const void> owner) {
  if (variants.gzip.empty() && variants.zstd.empty())
    return bytesReply(request, resource, variants.identity, std::move(owner));
  const ContentCoding coding = chooseCoding(request.acceptEncoding.value_or(""),
                                            !variants.gzip.empty(), !variants.zstd.empty());
  becomeVariant(resource, coding);
  const ByteView bytes = coding == ContentCoding::kZstd   ? variants.zstd
                         : coding == ContentCoding::kGzip ? variants.gzip
                                                          : variants.identity;
  return bytesReply(request, resource, bytes, std::move(owner));
}

}  // namespace qtet
