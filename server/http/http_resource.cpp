#include "server/http/http_resource.h"

#include <cassert>

#include "server/wire/http_date.h"

namespace qtet {
namespace {

Reply notModified(HeaderLines headers) {
  removeType(headers);
  Reply out;
  out.status = 304;
  out.headers = std::move(headers);
  return out;
}

Reply preconditionFailed(const Validators& now) {
  return problem(412, "precondition-failed",
                 "the resource is another one by now: its ETag is " + now.etag);
}

}  // namespace

Reply beginReply(unsigned status, const Resource& resource) {
  Reply out;
  out.status = status;
  out.headers = headOf(resource);
  return out;
}

std::optional<Reply> conditionalReply(const RequestView& request, const Resource& resource) {
  switch (evaluateConditions(request, resource.validators)) {
    case Verdict::kSend: return std::nullopt;
    case Verdict::kNotModified: return notModified(headOf(resource));
    case Verdict::kPreconditionFailed: break;
  }
  return preconditionFailed(resource.validators);
}

Reply rangeReply(const RequestView& request, Reply begun, ByteView bytes,
                 std::shared_ptr<const void> owner) {
  Validators validators;
  if (request.range && request.ifRange)
    validators = {std::string(begun.header("ETag")),
                  parseHttpDate(begun.header("Last-Modified")).value_or(0)};
  const ByteRange range = selectRange(request, validators, bytes.size());
  if (range.kind == ByteRange::Kind::kUnsatisfiable) {
    const std::string size = std::to_string(bytes.size());
    Reply out = problem(416, "range-not-satisfiable",
                        "the range starts behind the end; there are " + size + " bytes");
    out.headers.add("Content-Range", "bytes */" + size);
    return out;
  }
  begun.owner = std::move(owner);
  begun.body = bytes;
  if (range.kind == ByteRange::Kind::kWhole) return begun;
  assert(range.size > 0 && range.first + range.size <= bytes.size());
  begun.status = 206;
  begun.headers.remove("Accept-Ranges");  // the status says it
  begun.headers.add("Content-Range", "bytes " + std::to_string(range.first) + "-" +
                                         std::to_string(range.first + range.size - 1) + "/" +
                                         std::to_string(bytes.size()));
  begun.body = bytes.subspan(range.first, range.size);
  return begun;
}

Reply bytesReply(const RequestView& request, const Resource& resource, ByteView bytes,
                 std::shared_ptr<const void> owner) {
  if (std::optional<Reply> early = conditionalReply(request, resource)) return std::move(*early);
  return rangeReply(request, beginReply(200, resource), bytes, std::move(owner));
}

Reply formReply(const RequestView& request, const DocumentForm& form,
                std::shared_ptr<const void> owner) {
  switch (evaluateConditions(request, form.validators)) {
    case Verdict::kNotModified: return notModified(form.headers);
    case Verdict::kPreconditionFailed: return preconditionFailed(form.validators);
    case Verdict::kSend: break;
  }
  Reply out;
  out.headers = form.headers;
  return rangeReply(request, std::move(out), form.bytes, std::move(owner));
}

Reply documentReply(const RequestView& request, const Document& document,
                    std::shared_ptr<const void> owner) {
  const ContentCoding coding = chooseCoding(request.acceptEncoding.value_or(""),
                                            document.gzip.has_value(), document.zstd.has_value());
  return formReply(request, document.form(coding), std::move(owner));
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
