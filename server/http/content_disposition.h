// The header Content-Disposition (RFC 6266): what a browser calls what it saves.
#pragma once

#include <string>
#include <string_view>

namespace qtet {

enum class Disposition { kAttachment, kInline };

/// The header's value for a file of this name, which is UTF-8 without control characters. A name
/// that a quoted string cannot hold everywhere ('"', '\\', '%', or anything but ASCII) stands there
/// with '_' for these, and whole as `filename*` (RFC 8187), which every browser of today prefers.
[[nodiscard]] std::string contentDisposition(Disposition disposition, std::string_view name);

}  // namespace qtet
