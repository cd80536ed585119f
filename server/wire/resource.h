// Something that can be sent under a tag and a date, and the head of its answer.
#pragma once

#include <ctime>
#include <string>
#include <string_view>

#include "server/wire/content_coding.h"
#include "server/wire/header_lines.h"

namespace qtet {

inline constexpr std::string_view kRevalidate = "no-cache";
inline constexpr std::string_view kForEver = "public, max-age=31536000, immutable";

/// The values by which conditions compare a resource. `etag` is strong and has its quotes.
struct Validators {
  std::string etag;
  std::time_t modified = 0;
  /// For a coded variant, the tag of the uncoded one; else empty. If-Match accepts this tag too,
  /// since both stand for the same state of the resource.
  std::string plainEtag{};
};

/// Describes bytes, and how long they may be cached.
struct Resource {
  Validators validators;
  std::string type;
  std::string_view cacheControl = kRevalidate;
  HeaderLines headers{};
};

/// The headers of its answer with status 200.
[[nodiscard]] HeaderLines headOf(const Resource& resource);

/// `resource` as the variant of that coding: its tag, Vary and Content-Encoding.
void becomeVariant(Resource& resource, ContentCoding coding);

/// Lets any page measure how long it took to arrive.
void becomeMeasurable(Resource& resource);
/// The same, and an element of any page may load it, even if the page isolates itself (COEP).
void becomeEmbeddable(Resource& resource);

}  // namespace qtet
