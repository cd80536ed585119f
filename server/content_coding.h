// Which coding of a file a client takes (RFC 9110, 12.5.3).
#pragma once

#include <string_view>

namespace qtet {

/// Whether an Accept-Encoding of this value allows gzip: named, or through "*", and not with q=0.
[[nodiscard]] bool acceptsGzip(std::string_view acceptEncoding);

}  // namespace qtet
