// Something that can be sent, under conditions, in ranges and compressed: from bytes and a request
// to a reply (RFC 9110, 12-14).
#pragma once

#include <memory>
#include <string>

#include "server/http/http_conditions.h"
#include "server/http/http_message.h"
#include "server/wire/document.h"
#include "server/wire/resource.h"

namespace qtet {

/// The same bytes in every coding that there is; an empty one is not there.
struct Variants {
  ByteView identity, gzip, zstd;
};

/// Status and headers of the resource, no body.
[[nodiscard]] Reply beginReply(unsigned status, const Resource& resource);
/// 304 and 412; nullopt when the body is to be sent.
[[nodiscard]] std::optional<Reply> conditionalReply(const RequestView& request,
                                                    const Resource& resource);
/// `begun`, a 200 with its headers, with the bytes or the range of them that is asked for: 200, 206
/// or 416.
[[nodiscard]] Reply rangeReply(const RequestView& request, Reply begun, ByteView bytes,
                               std::shared_ptr<const void> owner);
/// 200, 206, 304, 412 or 416. The reply keeps `owner`, so that the bytes live as long as it.
[[nodiscard]] Reply bytesReply(const RequestView& request, const Resource& resource, ByteView bytes,
                               std::shared_ptr<const void> owner);
/// The same of the variant that the client likes best; every variant has a tag of its own.
[[nodiscard]] Reply variantReply(const RequestView& request, Resource resource,
                                 const Variants& variants, std::shared_ptr<const void> owner);
/// 200, 206, 304, 412 or 416 of that form, whose head is made already.
[[nodiscard]] Reply formReply(const RequestView& request, const DocumentForm& form,
                              std::shared_ptr<const void> owner);
/// The same of the form that the client likes best.
[[nodiscard]] Reply documentReply(const RequestView& request, const Document& document,
                                  std::shared_ptr<const void> owner);

}  // namespace qtet
