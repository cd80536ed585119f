// The header Content-Disposition (RFC 6266): what a browser calls what it saves.
#pragma once

#include <string>
#include <string_view>

namespace qtet {

enum class Disposition { kAttachment, kInline };

/// The header's value for a file of this name, which is UTF-8 without control characters. Some
/// characters are not safe in a quoted string ('"', '\\', '%', or anything but ASCII). A name with
/// such characters has '_' for them there, and is whole in `filename*` (RFC 8187). Every browser of
/// today prefers that.
[[nodiscard]] std::string contentDisposition(Disposition disposition, std::string_view name);

}  // namespace qtet
